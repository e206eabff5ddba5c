// From where Newton's method converges, with line search and without, in one step of a solid of 36 freedoms (Gast and
// Schroeder 2014, figure 2): a bar of twelve vertices, free and at rest, one end of which is anywhere in a square.
#include <cstdio>
#include <cstdlib>

#include "physics/deformable_lab.h"

namespace {

using namespace lab;

constexpr uint32_t kMostSteps = 500;
constexpr double kYoung = 1e5;  // [Pa]

// Solves until the step converged from where the end is about (x, y) [m], the middle half way; kMostSteps: it did not.
uint32_t solves_from(double x, double y, double h, bool search) {
    constexpr double kLongest = 0.1;  // step of a world [s]: a longer one is one of a stiffer solid
    const double young = kYoung * std::max(1.0, h / kLongest * h / kLongest);
    h = std::min(h, kLongest);
    const World world([&](taut_world_def& def) {
        def.solver = TAUT_SOLVER_MINIMISATION;
        def.time_step = static_cast<float>(h);
        def.substeps = 1;
        def.gravity = {0, 0, 0};
        def.sweeps = kMostSteps;
        def.line_search = search;
    });
    const Beam bar({1, 0.5, 0.5}, 3, 2, 2, false);
    taut_solid_def def = bar.def(TAUT_SOLID_FIXED_COROTATED, young, 0.3);
    std::vector<taut_pos> points = bar.points;
    for (taut_pos& p : points) {
        const double part = p.x;
        p.x += part * (x - 1);
        p.y += part * y;
    }
    def.rest = def.points;
    def.points = points.data();
    def.filter.mask = 0;
    const taut_solid solid = add(world, def);
    world.step();
    for (const Vec& p : points_of(solid))
        if (!finite(p)) return kMostSteps;
    const bool unfinished = !(static_cast<double>(world.profile().residual) * h < 1.01e-6);  // the tolerance of a step
    return unfinished ? kMostSteps : world.profile().solves;
}

// Rest is at (3/5, 1/2) of the picture.
struct Share {
    int failed = 0, pixels = 0;
    long solves = 0;
};
Share share_of(double h, bool search, int size, std::FILE* map) {
    constexpr double kSide = 2.5;  // [m]
    Share out;
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) {
            const double u = (column + 0.5) / size, v = (row + 0.5) / size;
            const uint32_t solves = solves_from(1 + kSide * (u - 0.6), kSide * (v - 0.5), h, search);
            ++out.pixels;
            out.failed += solves >= kMostSteps;
            out.solves += solves;
            if (map) std::fprintf(map, "%g,%d,%g,%g,%u\n", h, search, u, v, solves);
        }
    return out;
}

// The share of failures without the search grows with the step, up to a quarter; with it there are none. A picture's
// pixels as h,search,u,v,solves go to the file that TAUT_NEWTON_MAP names.
TEST(NewtonMap, FailsAtLongStepsWithoutTheSearchAlone) {
    const char* const file = std::getenv("TAUT_NEWTON_MAP");
    std::FILE* const map = file ? std::fopen(file, "w") : nullptr;
    const int size = map ? 100 : 10;
    int before = 0;
    for (const double a_second : {24.0 * 170, 24.0 * 40, 24.0 * 20, 24.0 * 10, 24.0, 1.0}) {
        const Share plain = share_of(1 / a_second, false, size, map);
        const Share searched = share_of(1 / a_second, true, size, map);
        std::printf("h = 1/%g s: %d of %d fail without the search, %d with it (%.1f solves)\n", a_second, plain.failed,
                    plain.pixels, searched.failed, static_cast<double>(searched.solves) / searched.pixels);
        EXPECT_EQ(searched.failed, 0) << a_second;
        EXPECT_GE(plain.failed, before) << a_second;
        before = plain.failed;
    }
    EXPECT_GT(before, size * size / 5);
    if (map) std::fclose(map);
}

}  // namespace
