// Whatever comes and goes, each slot reads what was set last, and equal values are held once.
#include "state/shared_values.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <random>
#include <set>
#include <vector>

#include "state/nodes.h"

namespace taut::test {
namespace {

struct Number {
    double x = 0;
    std::array<uint64_t, 1> words() const { return {std::bit_cast<uint64_t>(x)}; }
};

class SharedNumbers : public testing::TestWithParam<uint32_t> {
protected:
    Memory memory_{{}};
    SharedValues<Number> values_{memory_};
};

TEST_P(SharedNumbers, ReadAsSetLast) {
    std::mt19937 random(GetParam());
    const auto below = [&](uint32_t count) { return static_cast<uint32_t>(random() % count); };
    std::vector<double> expected;
    for (int change = 0; change < 5000; ++change) {
        if (expected.empty() || below(20) == 0) {
            values_.reserve(expected.size() + 1);
            values_.add();
            expected.push_back(0);
        }
        const uint32_t slot = below(static_cast<uint32_t>(expected.size()));
        const double number = below(2) == 0 ? below(5) : random();
        values_.reserve_values(1);
        values_.set(slot, {number});
        expected[slot] = number;
        for (uint32_t i = 0; i < expected.size(); ++i) ASSERT_EQ(values_[i].x, expected[i]) << change << ", slot " << i;
    }
    EXPECT_GT(expected.size(), 100u);
}

TEST_P(SharedNumbers, HoldsEqualOnesOnce) {
    constexpr uint32_t kSlots = 1000;
    values_.reserve(kSlots);
    for (uint32_t i = 0; i < kSlots; ++i) values_.add();
    const uint64_t before = memory_.bytes();
    std::set<const Number*> held;
    for (uint32_t i = 0; i < kSlots; ++i) {
        values_.reserve_values(1);
        values_.set(i, {double(i % (1 + GetParam()))});
    }
    for (uint32_t i = 0; i < kSlots; ++i) held.insert(&values_[i]);
    EXPECT_EQ(held.size(), 1 + GetParam());
    EXPECT_LE(memory_.bytes() - before, 64 * (2 + GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Seeds, SharedNumbers, testing::Range(1u, 9u));

// What equals by value but not bit by bit does not do the same.
TEST(SharedNumber, TellsApartTheSignOfZero) {
    Memory memory{{}};
    SharedValues<Number> values(memory);
    values.reserve(2);
    values.add();
    values.add();
    values.reserve_values(1);
    values.set(1, {-0.0});
    EXPECT_FALSE(std::signbit(values[0].x));
    EXPECT_TRUE(std::signbit(values[1].x));
}

// Each number of a mass counts.
TEST(SharedMasses, DifferByAnyOfTheirNumbers) {
    const auto changed = [](auto&& change) {
        NodeMass mass;
        change(mass);
        return mass.words();
    };
    std::set<std::array<uint64_t, 19>> all = {NodeMass{}.words()};
    size_t count = 1;
    const auto expect_another = [&](auto&& change) {
        all.insert(changed(change));
        EXPECT_EQ(all.size(), ++count);
    };
    expect_another([](NodeMass& m) { m.mass = 1; });
    expect_another([](NodeMass& m) { m.inv_mass = 1; });
    expect_another([](NodeMass& m) { m.gravity_scale = 2; });
    expect_another([](NodeMass& m) { m.isotropic = true; });
    for (int i = 0; i < 3; ++i) expect_another([&](NodeMass& m) { m.centre[i] = 1; });
    for (double Sym3::*number : {&Sym3::xx, &Sym3::yy, &Sym3::zz, &Sym3::xy, &Sym3::xz, &Sym3::yz}) {
        expect_another([&](NodeMass& m) { m.inertia.*number = 1; });
        expect_another([&](NodeMass& m) { m.inv_inertia.*number = 1; });
    }
}

}  // namespace
}  // namespace taut::test
