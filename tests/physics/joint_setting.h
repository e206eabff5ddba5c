// Rates and ways of solving that joints are tested at, as parameters of a suite.
#pragma once

#include "physics/joint_lab.h"

namespace lab {

struct JointSetting {
    double hz;
    taut_joint_solve solve;
};

inline std::vector<JointSetting> joint_settings() {
    std::vector<JointSetting> all;
    for (const taut_joint_solve solve : {TAUT_JOINT_SOLVE_DIRECT, TAUT_JOINT_SOLVE_SOFT})
        for (const double hz : {30.0, 60.0, 120.0, 240.0}) all.push_back({hz, solve});
    return all;
}

inline std::string name_of(const testing::TestParamInfo<JointSetting>& setting) {
    return std::to_string(static_cast<int>(setting.param.hz)) +
           (setting.param.solve == TAUT_JOINT_SOLVE_DIRECT ? "HzDirect" : "HzSwept");
}

// A world of the setting's rate.
class SettingWorld : public testing::TestWithParam<JointSetting> {
protected:
    explicit SettingWorld(const Vec& gravity)
        : world([&](taut_world_def& def) {
              def.gravity = gravity.narrow();
              def.time_step = static_cast<float>(1 / GetParam().hz);
          }) {}

    int frames(double time) const { return static_cast<int>(std::lround(time * GetParam().hz)); }
    void run(double time) const {
        for (int i = 0; i < frames(time); ++i) world.step();
    }
    taut_joint hinged(taut_body in, taut_body body, const Vec& place, const Vec& axis,
                      const taut_axis_def& angle = free_axis()) const {
        auto def = at(world, taut_hinge_joint_def_init, in, body, place, axis);
        def.angle = angle;
        def.base.solve = GetParam().solve;
        taut_joint out{};
        ok(taut_world_add_hinge_joint(world.handle, &def, &out));
        return out;
    }
    taut_joint sliding(taut_body in, taut_body body, const Vec& axis) const {
        auto def = at(world, taut_slider_joint_def_init, in, body, position(body), axis);
        def.base.solve = GetParam().solve;
        taut_joint out{};
        ok(taut_world_add_slider_joint(world.handle, &def, &out));
        return out;
    }

    const World world;
};

}  // namespace lab
