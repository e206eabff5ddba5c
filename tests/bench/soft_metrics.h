// Figures of cloths and solids, taken from positions and velocities alone: the same for every engine.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "crossings.h"
#include "engine.h"
#include "point_depth.h"

namespace bench {

// Of one cloth or solid.
struct SoftShape {
    explicit SoftShape(const scenes::Cloth& cloth);
    explicit SoftShape(const scenes::Solid& solid);

    // Warp and weft edges of a cloth, with their length at rest [m].
    struct Edge {
        uint32_t a, b;
        double rest;
    };
    std::vector<Edge> edges;
    std::vector<std::array<uint32_t, 3>> faces;  // of the sheet, of a solid's boundary
    std::vector<std::array<uint32_t, 2>> sides;  // of the faces
    std::vector<std::array<uint32_t, 4>> tets;   // tetrahedra, or those at the corners of hexahedra
    size_t tets_a_cell = 1;
    std::vector<double> mass;  // of each vertex, 0: pinned [kg]
    double size = 0;           // longest side of its box at rest [m]
};

class SoftMetrics {
public:
    // rigid: energy of the scene's bodies at the start, kinetic and of height [J]; mass: theirs [kg].
    SoftMetrics(const scenes::Scene& scene, const Engine& engine, uint32_t steps, double rigid, double mass);

    void after_step(uint32_t step, double rigid, const std::vector<Motion>& bodies);
    bool finite() const { return finite_; }
    double peak_pct() const { return 100 * peak_; }
    double end_pct() const { return 100 * end_; }
    double tip_ratio() const { return tip_count_ > 0 ? tip_sum_ / tip_count_ : 0; }
    double energy_lost() const { return energy_lost_; }  // [m]
    void report(nlohmann::ordered_json& json) const;

private:
    void read();
    double energy() const;
    void measure_stretch();
    void measure_depth(const std::vector<Motion>& bodies);
    void measure_cells(uint32_t step);
    void name_points();
    void measure_crossings();

    const scenes::Scene& scene_;
    const Engine& engine_;
    std::vector<SoftShape> shapes_;  // cloths, then solids
    std::vector<SoftState> states_;
    uint32_t one_second_, last_second_, last_;  // step that ends it; first step of the last one; last step
    bool finite_ = true;
    double peak_ = 0, end_ = 0, mean_ = 0;                     // stretch
    double deep_ = 0, deep_end_ = 0;                           // [m]
    double weight_ = 0, size_ = 0;                             // m g of all that moves [N], [m]
    double energy_start_ = 0, energy_most_ = 0, energy_lost_;  // [J], [J], [m]
    size_t inverted_ = 0, inverted_end_ = 0;                   // cells
    uint32_t inverted_until_ = 0;                              // steps after which none was, to the end
    std::vector<PointDepth> depths_;                           // of the scene's shapes
    std::vector<std::vector<uint32_t>> ids_;                   // of the vertices of each; those sewn together have one
    size_t pairs_ = 0, pairs_end_ = 0, pairs_own_ = 0, pairs_own_end_ = 0;  // that cross; own: of solids' own
    double tip_height_ = 0, tip_sum_ = 0, rest_sum_ = 0;
    uint64_t tip_count_ = 0, rest_count_ = 0;
};

}  // namespace bench
