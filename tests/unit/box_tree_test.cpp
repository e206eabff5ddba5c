// The tree of boxes beside a look at all of them, also after they moved.
#include "collision/box_tree.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace taut::collision {
namespace {

TEST(BoxTree, FindsWhatALookAtAllFinds) {
    const taut_hooks hooks{};
    Memory memory(hooks);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto point = [&] { return Vec3(uniform(random), uniform(random), uniform(random)); };
    for (const uint32_t count : {0u, 1u, 4u, 5u, 300u}) {
        std::vector<ItemBox> box(count);
        const auto move = [&] {
            for (ItemBox& each : box) {
                const Vec3 middle = point(), half = 0.1 * point().cwiseAbs();
                each = {middle - half, middle + half};
            }
        };
        move();
        BoxTree tree(memory);
        const auto box_of = [&](uint32_t i) { return box[i]; };
        tree.build(count, box_of);
        EXPECT_EQ(tree.items(), count);
        for (int round = 0; round < 3; ++round) {
            for (int i = 0; i < 100; ++i) {
                const Vec3 x = point();
                std::set<uint32_t> found, expected;
                tree.for_holding(x, [&](uint32_t item) {
                    if (box[item].holds(x)) found.insert(item);
                    return true;
                });
                double least = std::numeric_limits<double>::infinity();
                for (uint32_t k = 0; k < count; ++k) {
                    if (box[k].holds(x)) expected.insert(k);
                    least = std::min(least, box[k].distance_squared(x));
                }
                EXPECT_EQ(found, expected);
                const uint32_t nearest = tree.nearest(x, [&](uint32_t k) { return box[k].distance_squared(x); });
                if (count == 0)
                    EXPECT_EQ(nearest, UINT32_MAX);
                else
                    EXPECT_EQ(box[nearest].distance_squared(x), least);
            }
            move();
            tree.refit(box_of);
        }
    }
}

}  // namespace
}  // namespace taut::collision
