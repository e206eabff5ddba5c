// Newton's method with and without the line search, in one program by a switch: figures 3, 4 and 7 of Gast and
// Schroeder 2014, in small, and the steps a frame with which it converges by their figure 11 without it.
#include "scenes/running_scene.h"

namespace {

using namespace lab;

struct Figure {
    int number;
    const char* scene;
    uint32_t parts;                  // steps a frame with which Newton's method converges
    double seconds;                  // that are looked at
    void (*change)(scenes::Scene&);  // of the scene; null: none
};
void PrintTo(const Figure& figure, std::ostream* out) { *out << "figure_" << figure.number; }

// Of figure 3 the paper says that it is simple: stretched to twice its length in an eighth of a second.
void stretch_at_once(scenes::Scene& scene) {
    for (scenes::Motion& motion : scene.motions) motion.track.keys = {{0, 0, 0}, {0.125, 0.5, 0}};
}

class NewtonsMethod : public testing::TestWithParam<Figure> {
protected:
    // Time of the first step that it does not finish in 40 steps, or infinity [s].
    static double fails_at(bool search, uint32_t parts) {
        scenes::Scene plan = scenes::make_scene(GetParam().scene);
        if (GetParam().change) GetParam().change(plan);
        plan.world.line_search = search;
        plan.world.sweeps = 40;
        plan.world.time_step /= static_cast<float>(parts);
        RunningScene running(std::move(plan));
        const double step = running.scene.world.time_step;
        for (double time = 0; time < GetParam().seconds; time += step) {
            running.step();
            taut_profile profile{};
            profile.struct_size = sizeof profile;
            ok(taut_world_get_profile(running.world.world, &profile));
            const double left = profile.residual * step;  // what forces that are left would move [m]
            if (!(left < 1.001 * running.scene.world.minimise_tolerance)) return time;
        }
        return std::numeric_limits<double>::infinity();
    }
};

TEST_P(NewtonsMethod, ConvergesAtTheFrameRateWithTheSearchAlone) {
    EXPECT_EQ(fails_at(true, 1), std::numeric_limits<double>::infinity());
    EXPECT_LT(fails_at(false, 1), GetParam().seconds);
    EXPECT_EQ(fails_at(false, GetParam().parts), std::numeric_limits<double>::infinity());
}
INSTANTIATE_TEST_SUITE_P(Of, NewtonsMethod,
                         testing::Values(Figure{3, "cube_stretch9_e1e5", 3, 1, stretch_at_once},
                                         Figure{4, "cube_stretch9_e1e5", 5, 2.5, nullptr},
                                         Figure{7, "film_balls5_e1e5", 6, 1, nullptr}),
                         testing::PrintToStringParamName());

}  // namespace
