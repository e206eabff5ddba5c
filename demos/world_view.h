// Fills a draw list from any world, by what the C API tells of it: for recordings, whose scenes nobody knows.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "draw_parts.h"
#include "render/follow_camera.h"

namespace demo {

class WorldView {
public:
    // The camera follows what moves. aspect: width over height.
    WorldView(taut_world world, render::Renderer& renderer, float aspect)
        : world_(world), renderer_(renderer), aspect_(aspect) {}

    // After each step, of h [s].
    void step(float h);
    // Camera, stage, and all that is there now: bodies by their colliders, cables, joints, cloths and solids. Sensors
    // are seen through; what sleeps is darker, what is in quarantine red.
    void add(render::DrawList& list);

private:
    struct Drawn {
        scenes::Shape shape;
        uint32_t mesh = 0;
    };

    void settle();
    void find_ground(const std::vector<taut_body>& bodies);
    void add_body(render::DrawList& list, taut_body body);
    void add_colliders(render::DrawList& list, taut_body body, const taut_pose& pose, render::Instance instance);
    void add_cable(render::DrawList& list, taut_cable cable);
    void add_joints(render::DrawList& list);
    void add_softs(render::DrawList& list, const std::vector<taut_body>& bodies);
    const Drawn& drawn(taut_shape shape);
    size_t number_of(taut_body body);
    render::Vec3 at(taut_pos p) const { return vec(placement_.picture(p)); }

    taut_world world_;
    render::Renderer& renderer_;
    float aspect_;
    bool settled_ = false;
    Placement placement_;
    std::optional<double> ground_;  // height in the picture [m]
    std::optional<render::FollowCamera> camera_;
    std::map<uint64_t, Drawn> shapes_;    // by handle
    std::map<uint64_t, size_t> numbers_;  // of bodies, by handle
    std::set<uint64_t> between_;          // static bodies between the eye and what moves: they are seen through
    std::vector<taut_collider> colliders_;
    Surface surface_;
};

}  // namespace demo
