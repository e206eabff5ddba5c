// What a scene did, for other programs: as an animated glTF 2.0 file, and as a table of poses.
//
// Bodies, cables' segments, rods and ropes are nodes with samplers of translation and rotation (and of scale where
// their length changes). Cloths and solids are meshes with a morph target a recorded frame, positions and normals, of
// which two neighbouring ones have weights at any time: normals turn with the surface, and no vertex needs a node, a
// channel and a place among the joints of a skin, which they would with a joint a vertex. That costs a weight a target
// and frame, and some viewers bound how many targets they take: --every thins frames out.
#pragma once

#include <fstream>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "glb_file.h"
#include "render/draw_list.h"
#include "render/mesh.h"
#include "scenes/taut_world.h"

namespace demo {

class GltfExport {
public:
    GltfExport(const scenes::Scene& scene, const scenes::TautWorld& world) : scene_(scene), world_(world) {}

    void watch();              // after each step: what tears
    void record(double time);  // the world as it is [s]
    void write(const std::string& path);

private:
    struct Placed {  // a node over the frames
        std::vector<float> translations, rotations, scales;
    };
    struct Soft {  // a cloth or solid over the frames
        std::vector<std::vector<taut_pos>> frames;
        std::vector<uint32_t> split_from;  // of the vertices that tears made: where they were before
    };

    void record_rods();
    void put_rod(size_t rod, taut_pos a, taut_pos b, float radius);
    void record_cable(size_t cable);
    size_t material(const render::Colour& colour, bool both_sides, float roughness);
    size_t mesh(int shape, size_t material);
    size_t mesh_of(const std::vector<render::Vertex>& triangles, size_t material);
    size_t geometry(const std::vector<render::Vertex>& triangles, size_t& normals);
    void add_bodies();
    void add_parts(const scenes::Body& body, nlohmann::ordered_json& node, size_t material);
    void add_rods();
    void add_softs();
    void add_soft(const std::string& name, Soft& soft, const std::vector<uint32_t>& triangles, size_t material);
    void add_camera();
    size_t add_node(nlohmann::ordered_json node, const Placed& placed, bool with_scale);
    void animate(size_t node, const char* path, const std::vector<float>& values, size_t width);
    float reach() const;

    const scenes::Scene& scene_;
    const scenes::TautWorld& world_;
    GlbFile file_;
    std::vector<float> times_;
    std::vector<Placed> bodies_;
    std::vector<Placed> rods_;  // of distance joints, then of cables' segments
    std::vector<size_t> first_rod_of_cable_;
    std::vector<Soft> cloths_, solids_;
    std::map<std::tuple<float, float, float, bool, float>, size_t> materials_;
    std::map<std::pair<int, size_t>, size_t> meshes_;
    std::map<int, std::pair<size_t, size_t>> geometries_;  // of shapes: accessors of positions and normals
    size_t times_accessor_ = 0;
    nlohmann::ordered_json animation_;
};

// A line a body, and a vertex of a cloth or solid, for each recorded frame.
class PoseTable {
public:
    PoseTable(const std::string& path, const scenes::TautWorld& world);  // throws std::runtime_error
    void record(uint32_t frame, double time);
    void finish();  // throws std::runtime_error

private:
    std::string path_;
    std::ofstream file_;
    const scenes::TautWorld& world_;
};

}  // namespace demo
