// The fused contact sweep: the same bits from its three builds, and the same impulses as the generic rows.
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>
#include <random>
#include <utility>

#include "constraints/random.h"
#include "constraints/soft_contact.h"
#include "rig.h"
#include "solvers/projected_gauss_seidel.h"
#include "widths.h"

namespace taut::test {
namespace {

// ---------------------------------------------------------------- builds

constexpr uint32_t kGroups = 64, kNodes = 120;

// Lane groups of random contacts, with empty lanes, empty places and the world among the nodes.
struct Data {
    std::vector<LaneGroup> group;
    std::vector<LanePoint> point;
    std::vector<LaneDrive> drive;
    std::vector<LaneRolling> rolling;
    std::vector<SweepNode> node;
    std::vector<SweepShift> shift;
    std::vector<LaneTurns> turns;
    std::vector<SweepFlight> flight;
    std::vector<uint16_t> impacts;

    // bearing: the share of points that carry an impulse; the others are far apart.
    explicit Data(uint64_t seed, double bearing = 1)
        : node(kNodes), shift(kNodes), turns(kGroups), flight(kNodes), impacts(4 * kGroups) {
        std::mt19937_64 engine(seed);
        std::uniform_real_distribution<double> number(-1, 1);
        auto any = [&] { return static_cast<float>(number(engine)); };
        auto decade = [&] { return static_cast<float>(std::pow(10, 3 * number(engine))); };
        for (uint32_t i = 1; i < kNodes; ++i) {
            auto& [velocity, mass] = node[i];
            for (int k = 0; k < 3; ++k) {
                velocity.v[k] = 3 * any();
                velocity.w[k] = 3 * any();
                shift[i].dx[k] = 0.01f * any();
                flight[i].gained[k] = 0.1f * any();
                flight[i].moved[k] = 0.01f * any();
            }
            const Quat q = rotation_from_vector(0.02 * Vec3(number(engine), number(engine), number(engine)));
            for (int k = 0; k < 4; ++k) shift[i].dq[k] = static_cast<float>(q.coeffs()[k]);
            const float inv_mass = decade();
            const auto along = [&](uint32_t axis) { return i % 5 == 4 && i % 3 == axis ? 0 : inv_mass; };
            node[i].set_inv_mass(inv_mass, along(0), along(1), along(2));  // some have a locked axis
            for (int k = 0; k < 6; ++k) mass.inv_inertia[k] = inv_mass * (k < 3 ? 3 + any() : 0.3f * any());
        }
        std::vector<uint32_t> order(kNodes - 1);
        std::iota(order.begin(), order.end(), 1);
        for (uint32_t i = 0; i < kGroups; ++i) {
            std::shuffle(order.begin(), order.end(), engine);
            LaneGroup g{};
            std::fill(std::begin(g.stiffness), std::end(g.stiffness), 1.0f);
            g.bounces = i % 5 != 3;
            g.points = 1 + static_cast<uint32_t>(engine() % 4);
            for (int lane = 0; lane < kLanes; ++lane) {
                const bool empty = engine() % 8 == 0;
                g.pair[lane] = empty ? kNone : static_cast<uint32_t>(lane);
                g.a[lane] = empty || engine() % 8 == 0 ? 0 : order[static_cast<size_t>(2 * lane)];
                g.b[lane] = empty ? 0 : order[static_cast<size_t>(2 * lane + 1)];
                const Vec3f n = Vec3f(any(), any(), any()).normalized(), t = tangent_of(n);
                for (int k = 0; k < 3; ++k) {
                    g.normal[k][lane] = empty ? 0 : n[k];
                    g.tangent[k][lane] = empty ? 0 : t[k];
                }
                g.friction[lane] = empty ? 0 : std::abs(any());
            }
            if (i % 3 == 1) add_drive(g, any);
            if (i % 4 == 2) add_rolling(g, any);
            if (i % 5 == 3) add_axes(g, any);
            for (uint32_t k = 0; k < g.points; ++k) {
                LanePoint p{};
                for (int lane = 0; lane < kLanes; ++lane) {
                    if (g.pair[lane] == kNone || engine() % 8 == 0) continue;
                    for (int c = 0; c < 3; ++c) {
                        p.ra[c][lane] = any();
                        p.rb[c][lane] = any();
                    }
                    p.normal_mass[lane] = 1;
                    p.restitution[lane] = engine() % 2 ? std::abs(any()) : 0;
                    const bool bears = bearing == 1 || 0.5 + 0.5 * number(engine) < bearing;
                    p.gap0[lane] = p.gap[lane] = bears ? 0.02f * any() : 1;
                    if (!bears) continue;
                    p.impulse[0][lane] = std::abs(any());
                    p.impulse[1][lane] = 0.3f * any();
                    p.impulse[2][lane] = 0.3f * any();
                }
                point.push_back(p);
            }
            group.push_back(g);
        }
        for (LaneTurns& of : turns)
            for (int lane = 0; lane < kLanes; ++lane)
                for (int side = 0; side < 2; ++side) {
                    of.turned[side][lane] = engine() % 3 == 0;
                }
        LanePoint* next = point.data();
        for (LaneGroup& g : group) g.point = std::exchange(next, next + g.points);
    }

    template <class Any>
    void add_drive(LaneGroup& g, Any& any) {
        g.first_drive = static_cast<uint32_t>(drive.size());
        for (uint32_t k = 0; k < g.points; ++k) {
            LaneDrive& d = drive.emplace_back();
            for (int lane = 0; lane < kLanes; ++lane) {
                for (int t = 0; t < 2; ++t) d.speed[t][lane] = g.pair[lane] == kNone ? 0 : 2 * any();
                const bool slips_alike = k % 2 == 0;  // of a lane all points have the same part
                d.part[lane] = lane % 3 == 0 ? 1 : 0.01f + 0.9f * static_cast<float>(lane) / kLanes;
                d.friction[0][lane] = g.friction[lane];
                d.friction[1][lane] = slips_alike ? g.friction[lane] : 1.5f * g.friction[lane];
                d.slides[lane] = lane % 2 == 0 ? 1 : 0.0f;
            }
        }
    }
    template <class Any>
    void add_rolling(LaneGroup& g, Any& any) {
        g.rolling = static_cast<uint32_t>(rolling.size());
        LaneRolling& r = rolling.emplace_back();
        for (int lane = 0; lane < kLanes; ++lane) {
            const bool none = g.pair[lane] == kNone || any() < -0.5f;
            for (int t = 0; t < 2; ++t) r.arm[t][lane] = none ? 0 : 0.1f * std::abs(any());
            for (int t = 0; t < 3; ++t) r.impulse[t][lane] = none ? 0 : 0.01f * any();
        }
    }

    template <class Any>
    void add_axes(LaneGroup& g, Any& any) {
        if (g.rolling == kNoLanes) {
            g.rolling = static_cast<uint32_t>(rolling.size());
            rolling.emplace_back();
        }
        g.has_axes = 1;
        LaneRolling& of = rolling[g.rolling];
        for (int lane = 0; lane < kLanes; ++lane)
            for (int side = 0; side < 2; ++side) {
                if (g.pair[lane] == kNone || any() < 0) continue;
                const Vec3f axis = Vec3f(any(), any(), any()).normalized();
                const Vec3f n(g.normal[0][lane], g.normal[1][lane], g.normal[2][lane]);
                const Vec3f outward = side == 0 ? n : Vec3f(-n), beside = outward - axis.dot(outward) * axis;
                for (int i = 0; i < 3; ++i) {
                    of.axis[side][i][lane] = axis[i];
                    of.across[side][i][lane] = beside[i] / beside.norm();
                }
                for (uint32_t k = 0; k < g.points; ++k) of.rim[k][side][lane] = std::abs(any());
            }
    }

    // Everything that a step calls, over and over, of some groups.
    void run(const ContactKernels& kernels, uint32_t begin = 0, uint32_t end = kGroups) {
        const LaneView view{group.data(), drive.data(), rolling.data()};
        const SweepTerms terms = contact_terms(1.0 / 240);
        kernels.prepare(view, begin, end, node.data());
        kernels.warm_start(view, begin, end, node.data());
        for (int i = 0; i < 4; ++i) {
            kernels.sweep_biased(view, begin, end, node.data(), shift.data(), terms);
            if (i == 2)
                for (uint32_t g = begin; g < end; ++g) kernels.turn(view, g, turns[g], shift.data(), node.data());
        }
        for (int i = 0; i < 2; ++i) kernels.sweep_relaxed(view, begin, end, node.data(), terms);
        kernels.find_impacts(view, begin, end, node.data(), shift.data(), flight.data(), {240, 0.04f}, impacts.data());
    }
    void slow_down(uint32_t g, int lane, float scale) {
        for (const uint32_t at : {group[g].a[lane], group[g].b[lane]})
            for (float* speed : {node[at].velocity.v, node[at].velocity.w})
                for (int k = 0; k < 3; ++k) speed[k] *= scale;
    }
    // Takes all pairs of a group away but one.
    void leave_alone(uint32_t g, int lane) {
        LaneGroup& of = group[g];
        for (int other = 0; other < kLanes; ++other) {
            if (other == lane) continue;
            of.pair[other] = kNone;
            of.a[other] = of.b[other] = 0;
            for (uint32_t k = 0; k < of.points; ++k) {
                LanePoint& p = of.point[k];
                p.normal_mass[other] = 0;
                for (auto& impulse : p.impulse) impulse[other] = 0;
            }
            if (of.rolling == kNoLanes) continue;
            LaneRolling& r = rolling[of.rolling];
            for (auto& arm : r.arm) arm[other] = 0;
            for (auto& impulse : r.impulse) impulse[other] = 0;
        }
    }
};

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expect_same_bits(const ContactKernels& kernels) {
    for (uint64_t seed = 1; seed <= 50; ++seed) {
        SCOPED_TRACE(testing::Message() << kernels.name << ", seed " << seed);
        const double bearing = seed % 2 ? 1 : 0.1;
        Data scalar(seed, bearing), other(seed, bearing);
        scalar.run(kContactKernelsScalar);
        other.run(kernels);
        float sum = 0;
        for (const SweepNode& n : scalar.node) sum += n.velocity.v[0] + n.velocity.w[2];
        ASSERT_TRUE(std::isfinite(sum));
        ASSERT_TRUE(same_bits(scalar.node, other.node));
        ASSERT_TRUE(same_bits(scalar.point, other.point));
        ASSERT_TRUE(same_bits(scalar.drive, other.drive));
        ASSERT_TRUE(same_bits(scalar.impacts, other.impacts));
        ASSERT_NE(std::accumulate(scalar.impacts.begin(), scalar.impacts.end(), 0u), 0u);
        ASSERT_FALSE(scalar.rolling.empty());
        ASSERT_TRUE(same_bits(scalar.rolling, other.rolling));
    }
}

TEST(ContactKernels, EveryBuildHasTheBitsOfTheScalarOne) {
    for (const ContactKernels* build : builds_here({TAUT_BUILDS(kContactKernels)})) {
        SCOPED_TRACE(build->name);
        expect_same_bits(*build);
    }
}

TEST(ContactKernels, TheWidestOfTheMachineIsChosen) {
    EXPECT_EQ(&contact_kernels(), builds_here({TAUT_BUILDS(kContactKernels)}).back());
#if defined(__x86_64__)
    EXPECT_GE(widest(), __builtin_cpu_supports("avx2") ? Width::avx2 : Width::base);
#else
    EXPECT_EQ(widest(), Width::base);
#endif
}

// Lanes and places without a contact stay as they are, and so does the world.
TEST(ContactKernels, EmptyPlacesStayEmpty) {
    Data data(9);
    data.run(kContactKernelsBase);
    for (const LaneGroup& g : data.group)
        for (uint32_t k = 0; k < g.points; ++k)
            for (int lane = 0; lane < kLanes; ++lane) {
                const LanePoint& p = g.point[k];
                if (p.ra[0][lane] != 0 || g.pair[lane] != kNone) continue;
                EXPECT_EQ(p.impulse[0][lane], 0);
                EXPECT_EQ(p.impulse[1][lane], 0);
                EXPECT_EQ(p.normal_mass[lane], 0);
            }
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(data.node[0].velocity.v[k], 0);
        EXPECT_EQ(data.node[0].velocity.w[k], 0);
    }
}

// Where no lane bears anything, sweeps pass on; where nobody slides, nothing is cut short. Who shares a group decides
// whether they may, but no bit: of velocities none, of impulses at most the sign of a 0. Nor where squares of speeds
// are too small for a float: friction without a push was let through there, unless nobody beside it slid.
class LaneDoesNotFeelTheOthers : public testing::TestWithParam<float> {};

TEST_P(LaneDoesNotFeelTheOthers, AtSpeed) {
    for (uint32_t g = 0; g < kGroups; ++g)
        for (const int lane : {0, 5, 15}) {
            SCOPED_TRACE(testing::Message() << "group " << g << ", lane " << lane);
            Data all(77, 0.15), alone(77, 0.15);
            if (all.group[g].pair[lane] == kNone) continue;
            alone.leave_alone(g, lane);
            for (Data* each : {&all, &alone}) {
                each->slow_down(g, lane, GetParam());
                each->run(kContactKernelsBase, g, g + 1);
            }
            for (const uint32_t node : {all.group[g].a[lane], all.group[g].b[lane]})
                ASSERT_EQ(0, std::memcmp(&all.node[node], &alone.node[node], sizeof(SweepNode)));
            for (uint32_t k = 0; k < all.group[g].points; ++k)
                for (int row = 0; row < 3; ++row)
                    ASSERT_EQ(all.group[g].point[k].impulse[row][lane], alone.group[g].point[k].impulse[row][lane])
                        << "point " << k;
        }
}

INSTANTIATE_TEST_SUITE_P(ContactKernels, LaneDoesNotFeelTheOthers, testing::Values(1.0f, 1e-15f, 1e-25f, 1e-35f),
                         [](const auto& tested) { return "scaled_" + std::to_string(tested.index); });

// ---------------------------------------------------------------- rows

// Friction torques, and surfaces that run, of some pairs.
void add_surface(Pair& pair, Random& random) {
    if (random.unit() < 0.5) {
        pair.spinning = static_cast<float>(0.05 * random.unit());
        pair.rolling = static_cast<float>(0.1 * random.unit());
        const Vec3 carried = 0.01 * random.vector();
        pair.torque = {static_cast<float>(carried.x()), static_cast<float>(carried.y()),
                       static_cast<float>(carried.z())};
    }
    if (random.unit() < 0.5) return;
    pair.driven = true;
    pair.drive = random.vector().cast<float>();
    pair.drive_spin = random.vector().cast<float>();
}

// Friction by direction of some pairs.
void add_law(Pair& pair, Random& random) {
    if (random.unit() < 0.3) return;
    const Vec3f along = random.vector().cast<float>(), n = pair.manifold.normal;
    pair.directed = true;
    pair.slide_direction = (along - n.dot(along) * n).normalized();
    pair.slide_factor = static_cast<float>(0.05 + 0.9 * random.unit());
}

// Bodies of many masses touching at random, with impulses carried in: a few colours, none of them the last.
void build_pile(Rig& rig, uint64_t seed) {
    Random random(seed);
    constexpr uint32_t kBodies = 16;
    rig.fixed();
    for (uint32_t i = 0; i < kBodies; ++i) {
        const double mass = std::pow(10.0, 1.5 * random.unit());
        const Vec3 x = 2 * random.vector(), v = random.vector(), spin = random.vector();
        const double a = 0.5 + random.unit(), b = 0.5 + random.unit(), c = (a + b) * (0.6 + 0.4 * random.unit());
        rig.body(mass, 0.1 * mass * Vec3(a, b, c), x, random.rotation(), v, spin);
    }
    for (uint32_t a = 0; a < kBodies; ++a) {
        for (uint32_t b : {a + 1, a + 1 + static_cast<uint32_t>(random.unit() * (kBodies - a))}) {
            if (a > 0 && b == a) continue;
            const uint64_t key = pair_key(a, b);
            bool known = false;
            for (const Pair& pair : rig.w.pairs.list) known = known || pair.key == key;
            if (known) continue;
            std::vector<std::pair<Vec3, double>> points;
            const Vec3 at = rig.w.nodes.motion[b].x + 0.5 * random.vector();
            const uint32_t count = 1 + static_cast<uint32_t>(random.unit() * 4);
            for (uint32_t k = 0; k < count; ++k) {
                const Vec3 beside = at + 0.3 * random.vector();
                points.push_back({beside, 0.01 * (2 * random.unit() - 1)});
            }
            rig.contact(a, b, random.vector().normalized().cast<float>(), points);
            for (Pair& pair : rig.w.pairs.list) {
                if (pair.key != key) continue;
                pair.friction = static_cast<float>(random.unit());
                if (seed % 2 == 0) add_surface(pair, random);
                for (int k = 0; k < pair.manifold.count; ++k) {
                    pair.force[k].normal = static_cast<float>(240 * random.unit());
                    pair.force[k].tangent1 = static_cast<float>(48 * random.unit());
                    pair.force[k].tangent2 = static_cast<float>(-48 * random.unit());
                }
                if (seed % 4 > 1) add_law(pair, random);
            }
        }
    }
}

std::vector<Vec3> impulses(const Rig& rig) {
    std::vector<Vec3> out;
    for (const Pair& pair : rig.w.pairs.list)
        for (int k = 0; k < pair.manifold.count; ++k)
            out.push_back(Vec3(pair.force[k].normal, pair.force[k].tangent1, pair.force[k].tangent2));
    for (const Pair& pair : rig.w.pairs.list)
        out.push_back(Vec3(pair.torque.normal, pair.torque.tangent1, pair.torque.tangent2));
    return out;
}

void expect_same(const Rig& lanes, const Rig& rows) {
    const std::vector<Vec3> a = impulses(lanes), b = impulses(rows);
    ASSERT_EQ(a.size(), b.size());
    double largest = 0;
    for (const Vec3& p : b) largest = std::max(largest, p.norm());
    ASSERT_GT(largest, 0);
    for (size_t i = 0; i < a.size(); ++i) EXPECT_LE((a[i] - b[i]).norm(), 1e-4 * largest) << "point " << i;
    const Eigen::VectorXd u = velocities(lanes), v = velocities(rows);
    EXPECT_LE((u - v).norm(), 1e-4 * v.norm());
}

class FusedSweep : public testing::TestWithParam<uint64_t> {
protected:
    // The same pile, in lanes and as rows.
    void SetUp() override {
        Solver by_rows = kProjectedGaussSeidel;
        by_rows.lanes = false;
        for (Rig* rig : {&lanes, &rows}) {
            build_pile(*rig, GetParam());
            rig->settings.sweeps = 3;
            rig->begin(rig == &lanes ? kProjectedGaussSeidel : by_rows);
            rig->predict();
        }
        ASSERT_FALSE(lanes.w.system.contacts.group.empty());
        ASSERT_TRUE(rows.w.system.contacts.group.empty());
        ASSERT_LT(lanes.w.partition.colours, kMaxColours);
    }

    Rig lanes, rows;
};
INSTANTIATE_TEST_SUITE_P(Seeds, FusedSweep, testing::Range<uint64_t>(1, 41));

TEST_P(FusedSweep, HasTheImpulsesOfTheGenericRows) {
    for (Rig* rig : {&lanes, &rows}) {
        rig->solve();
        rig->store_contacts();
    }
    expect_same(lanes, rows);
    for (Rig* rig : {&lanes, &rows}) {
        rig->move();
        rig->relax();
        rig->store_contacts();
    }
    expect_same(lanes, rows);
}

// Between detections the anchors, each on its own surface, turn with their bodies: gap0 + n . (shift of b - shift of a)
// is C at the new poses.
TEST_P(FusedSweep, FollowsTheGapAsTheBodiesMove) {
    const std::vector<System::Found> found_at(lanes.w.system.found.begin(), lanes.w.system.found.end());
    for (int substep = 0; substep < 3; ++substep) {
        for (Rig* rig : {&lanes, &rows}) {
            if (substep > 0) rig->predict();
            rig->solve();
            rig->move();
            rig->relax();
        }
    }
    // Gap of the last substep's start, each at its own poses: compared within the lanes' rig.
    Rig& rig = lanes;
    rig.predict();
    Substep s = rig.substep();
    sweep_biased(s);
    // Those that turned so far that their levers followed have none of the frame's beginning any more.
    const auto turned = [&](uint32_t node) {
        return rig.w.system.found[rig.w.system.at(node)].q.coeffs() != found_at[rig.w.system.at(node)].q.coeffs();
    };
    int compared = 0, skipped = 0;
    for (const LaneGroup& g : rig.w.system.contacts.group)
        for (int lane = 0; lane < kLanes; ++lane) {
            if (g.pair[lane] == kNone) continue;
            const Pair& pair = rig.w.pairs.list[g.pair[lane]];
            const bool skips = turned(pair.a) || turned(pair.b);
            ++(skips ? skipped : compared);
            for (int k = 0; k < pair.manifold.count && !skips; ++k) {
                const collision::ContactPoint& point = pair.manifold.points[k];
                double moved[2];
                for (int end = 0; end < 2; ++end) {
                    const uint32_t node = end == 0 ? pair.a : pair.b;
                    const System::Found& found = rig.w.system.found[rig.w.system.at(node)];
                    const System::Found& of_a =
                        rig.w.system.found[rig.w.system.at(pair.a)];  // its centre is its origin here
                    const Vec3 half = (0.5f * point.separation * pair.manifold.normal).cast<double>();
                    const Vec3 at = of_a.x + point.position.cast<double>() + (end == 0 ? -half : half);
                    const NodeMotion& m = rig.w.nodes.motion[node];
                    const Vec3 now = m.x + m.q * (found.q.conjugate() * (at - found.x));
                    moved[end] = pair.manifold.normal.cast<double>().dot(now - at);
                }
                const double gap = point.separation + moved[1] - moved[0];
                EXPECT_NEAR(g.point[k].gap[lane], gap, 1e-6);
            }
        }
    EXPECT_GT(compared, 2 * skipped);
}

}  // namespace
}  // namespace taut::test
