// Sets of elements against a plain list of records, through random changes.
#include <gtest/gtest.h>

#include <random>

#include "state/elements.h"

namespace taut::test {
namespace {

struct ElementRecord {
    std::array<uint32_t, 2> node;
    double softness, lambda, drift, data;
    bool lives;
};

class Sets : public testing::Test {
protected:
    void expect_same(const ElementSet& set, const std::vector<ElementRecord>& records) {
        ASSERT_EQ(set.size(), records.size());
        for (uint32_t i = 0; i < set.size(); ++i) {
            ASSERT_EQ(set.lives(i), records[i].lives);
            ASSERT_EQ(set.softness[i], records[i].softness);
            ASSERT_EQ(*set.lambda_of(i), records[i].lambda);
            ASSERT_EQ(*set.drift_of(i), records[i].drift);
            ASSERT_EQ(*set.data_of(i), records[i].data);
            if (set.lives(i)) {
                ASSERT_TRUE(std::ranges::equal(set.nodes_of(i), records[i].node));
            }
        }
    }

    Memory memory{taut_hooks{}};
    Elements elements{memory};
};

TEST_F(Sets, FollowTheirChanges) {
    std::mt19937 random(1);
    const auto below = [&](size_t n) { return static_cast<uint32_t>(random() % n); };
    const uint32_t index = elements.add(kLinkElement);
    std::vector<ElementRecord> records;
    for (int i = 0; i < 2000; ++i) {
        ElementSet& set = elements.set[index];
        const uint64_t version = set.version;
        const uint32_t what = below(8);
        if (records.empty() || what < 4) {
            const uint32_t at = below(records.size() + 1);
            const ElementRecord made{{below(99), below(99)}, 0.25 * below(99), -1.0 * below(99),
                                     0.5 * below(9),         1.0 * i,          true};
            reserve_elements(set, 1);
            elements.insert(set, at, made.node, made.softness);
            EXPECT_TRUE(set.fresh[at]);
            *set.lambda_of(at) = made.lambda, *set.drift_of(at) = made.drift, *set.data_of(at) = made.data;
            records.insert(records.begin() + at, made);
        } else if (what < 6) {
            const uint32_t at = below(records.size());
            elements.erase(set, at);
            records.erase(records.begin() + at);
        } else {
            ElementRecord& record = records[below(records.size())];
            const auto at = static_cast<uint32_t>(&record - records.data());
            if (what == 6 && record.lives) {
                elements.kill(set, at);
                record.lives = false, record.lambda = 0;
            } else if (record.lives) {
                record.node = {record.node[1] + 1, below(99)};
                elements.tie(set, at, record.node);
            } else {
                continue;
            }
        }
        EXPECT_GT(set.version, version);
        ASSERT_NO_FATAL_FAILURE(expect_same(set, records));
        const auto living = std::ranges::count(records, true, &ElementRecord::lives);
        ASSERT_EQ(elements.count(), static_cast<uint32_t>(living));
    }
}

TEST_F(Sets, OfOneSlotAreToldApart) {
    const uint32_t first = elements.add(kLinkElement);
    const uint64_t serial = elements.set[first].serial;
    elements.remove(first);
    EXPECT_EQ(elements.set[first].type, nullptr);
    const uint32_t again = elements.add(kBendElement);
    EXPECT_EQ(again, first);
    EXPECT_NE(elements.set[again].serial, serial);
    EXPECT_EQ(elements.set[again].size(), 0u);
}

TEST_F(Sets, KnowTheInverseOfTheirCompliance) {
    ElementSet& set = elements.set[elements.add(kBendElement)];
    const double c[9] = {3, 1, 0, 1, 2, 0.5, 0, 0.5, 1};
    set_compliance(set, c, 0.1);
    EXPECT_TRUE(set.coupled);
    using Block = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    EXPECT_TRUE((Block::Map(set.compliance) * Block::Map(set.stiffness)).isIdentity(1e-14));
    set_compliance(set, 0.25, 0);
    EXPECT_FALSE(set.coupled);
    EXPECT_TRUE(Block::Map(set.stiffness).isApprox(4 * Mat3::Identity()));
    set_compliance(set, 0, 0);
    EXPECT_TRUE(Block::Map(set.stiffness).isZero(0));
}

}  // namespace
}  // namespace taut::test
