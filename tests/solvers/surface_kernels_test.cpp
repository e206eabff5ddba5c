// Contacts of surfaces in lanes: the same bits from their builds, the impulses of the generic rows, and as rows of
// blocks.
#include <gtest/gtest.h>

#include <cstring>
#include <numeric>
#include <random>

#include "check/validate.h"
#include "constraints/random.h"
#include "constraints/soft_contact.h"
#include "rig.h"
#include "solvers/projected_gauss_seidel.h"
#include "widths.h"

namespace taut::test {
namespace {

// ---------------------------------------------------------------- builds

constexpr uint32_t kSurfaceGroups = 48, kSurfaceSeats = 120;

// Lane groups of random contacts, with empty lanes, unused nodes and the world among the nodes; in every third first
// nodes turn.
struct SurfaceData {
    std::vector<SurfaceGroup> group;
    std::vector<SurfaceTurning> turning;
    std::vector<SweepNode> node;
    std::vector<SweepShift> shift;
    alignas(64) float turned[kLanes];

    explicit SurfaceData(uint64_t seed) : node(kSurfaceSeats), shift(kSurfaceSeats) {
        Random random(seed);
        const auto any = [&] { return static_cast<float>(random.between(-1, 1)); };
        for (uint32_t i = 1; i < kSurfaceSeats; ++i) {
            auto& [velocity, mass] = node[i];
            for (int k = 0; k < 3; ++k) {
                velocity.v[k] = 3 * any();
                velocity.w[k] = 3 * any();
                shift[i].dx[k] = 0.01f * any();
            }
            const Quat q = rotation_from_vector(0.02 * random.vector());
            for (int k = 0; k < 4; ++k) shift[i].dq[k] = static_cast<float>(q.coeffs()[k]);
            const float inv_mass = std::pow(10.0f, 3 * any());
            const auto along = [&](uint32_t axis) { return i % 5 == 4 && i % 3 == axis ? 0 : inv_mass; };
            node[i].set_inv_mass(inv_mass, along(0), along(1), along(2));  // some have a locked axis
            for (int k = 0; k < 6; ++k) mass.inv_inertia[k] = inv_mass * (k < 3 ? 3 + any() : 0.3f * any());
        }
        std::mt19937_64 engine(seed);
        std::vector<uint32_t> order(kSurfaceSeats - 1);
        std::iota(order.begin(), order.end(), 1);
        for (uint32_t i = 0; i < kSurfaceGroups; ++i) {
            std::shuffle(order.begin(), order.end(), engine);
            SurfaceGroup g{};
            SurfaceTurning t{};
            for (int lane = 0; lane < kLanes; ++lane) fill(g, t, lane, &order[4 * static_cast<size_t>(lane)], random);
            if (i % 3 == 0) {
                g.turning = static_cast<uint32_t>(turning.size());
                turning.push_back(t);
            }
            group.push_back(g);
        }
        for (float& each : turned) each = random.unit() < 0.3 ? 1.0f : 0.0f;
    }
    static void fill(SurfaceGroup& g, SurfaceTurning& t, int lane, const uint32_t* of, Random& random) {
        const auto any = [&] { return static_cast<float>(random.between(-1, 1)); };
        const bool empty = random.unit() < 0.15;
        g.contact[lane] = empty ? kNoLanes : static_cast<uint32_t>(lane);
        if (empty) return;
        float sum = 0;
        for (uint32_t n = 0; n < kSurfaceNodes; ++n) {
            if (n > 1 && random.unit() < 0.2) continue;
            g.node[n][lane] = random.unit() < 0.15 ? 0 : of[n];
            g.weight[n][lane] = n == 3 ? -sum : any();
            sum += g.weight[n][lane];
        }
        const Vec3f normal = Vec3f(any(), any(), any()).normalized(), t1 = tangent_of(normal);
        for (int k = 0; k < 3; ++k) {
            g.normal[k][lane] = normal[k];
            g.tangent[k][lane] = t1[k];
            t.lever[k][lane] = any();
            t.skin[k][lane] = 0.3f * any();
        }
        g.gap0[lane] = 0.02f * any();
        g.friction[lane] = std::abs(any());
        for (int k = 0; k < 2; ++k) g.drive[k][lane] = any();
        if (random.unit() < 0.3) return;
        g.impulse[0][lane] = std::abs(any());
        for (int k = 1; k < 3; ++k) g.impulse[k][lane] = 0.3f * any();
    }

    // Masses of nodes as assembly would fill them in, then everything that a step calls, over and over.
    void run(const SurfaceKernels& kernels, uint32_t begin = 0, uint32_t end = kSurfaceGroups) {
        const SurfaceView view{group.data(), turning.data()};
        const SweepTerms terms = contact_terms(1.0 / 240);
        for (SurfaceGroup& g : group)
            for (uint32_t n = 0; n < kSurfaceNodes; ++n)
                for (int lane = 0; lane < kLanes; ++lane) g.inv_mass[n][lane] = node[g.node[n][lane]].mass.inv_mass;
        kernels.prepare(view, begin, end, node.data());
        kernels.warm_start(view, begin, end, node.data());
        for (int i = 0; i < 4; ++i) {
            kernels.sweep_biased(view, begin, end, node.data(), shift.data(), terms);
            for (uint32_t g = begin; i == 2 && g < end; ++g)
                if (group[g].turning != kNoLanes) kernels.turn(view, g, turned, shift.data(), node.data());
        }
        for (int i = 0; i < 2; ++i) kernels.sweep_relaxed(view, begin, end, node.data(), terms);
    }
    void leave_alone(uint32_t g, int lane) {
        for (int other = 0; other < kLanes; ++other) {
            if (other == lane) continue;
            group[g].contact[other] = kNoLanes;
            for (uint32_t n = 0; n < kSurfaceNodes; ++n) {
                group[g].node[n][other] = 0;
                group[g].weight[n][other] = 0;
            }
            for (auto& row : group[g].impulse) row[other] = 0;
        }
    }
};

template <class T>
bool same_memory(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expect_surface_bits(const SurfaceKernels& kernels) {
    for (uint64_t seed = 1; seed <= 50; ++seed) {
        SCOPED_TRACE(testing::Message() << kernels.name << ", seed " << seed);
        SurfaceData scalar(seed), other(seed);
        scalar.run(kSurfaceKernelsScalar);
        other.run(kernels);
        float sum = 0;
        for (const SweepNode& n : scalar.node) sum += n.velocity.v[0] + n.velocity.w[2];
        ASSERT_TRUE(std::isfinite(sum));
        ASSERT_TRUE(same_memory(scalar.node, other.node));
        ASSERT_TRUE(same_memory(scalar.group, other.group));
        ASSERT_TRUE(same_memory(scalar.turning, other.turning));
        ASSERT_EQ(scalar.node[0].velocity.v[0], 0);
    }
}

TEST(SurfaceKernels, EveryBuildHasTheBitsOfTheScalarOne) {
    for (const SurfaceKernels* build : builds_here({TAUT_BUILDS(kSurfaceKernels)})) {
        SCOPED_TRACE(build->name);
        expect_surface_bits(*build);
    }
}

TEST(SurfaceKernels, LaneDoesNotFeelTheOthers) {
    for (uint32_t g = 0; g < kSurfaceGroups; ++g)
        for (const int lane : {0, 5, 15}) {
            SCOPED_TRACE(testing::Message() << "group " << g << ", lane " << lane);
            SurfaceData all(77), alone(77);
            if (all.group[g].contact[lane] == kNoLanes) continue;
            alone.leave_alone(g, lane);
            for (SurfaceData* each : {&all, &alone}) each->run(kSurfaceKernelsBase, g, g + 1);
            for (const auto& seats : all.group[g].node)
                ASSERT_EQ(0, std::memcmp(&all.node[seats[lane]], &alone.node[seats[lane]], sizeof(SweepNode)));
            for (int row = 0; row < 3; ++row)
                ASSERT_EQ(all.group[g].impulse[row][lane], alone.group[g].impulse[row][lane]);
        }
}

// ---------------------------------------------------------------- rows

SurfaceContact& touch_surface(Rig& rig, const std::vector<std::pair<uint32_t, double>>& nodes, const Vec3& normal,
                              double gap, const Vec3& lever = Vec3::Zero()) {
    auto& list = rig.w.pairs.surfaces.contact;
    SurfaceContact& contact = list.emplace_back();
    contact.a = list.size();
    contact.b = contact.a + 1;
    for (size_t n = 0; n < nodes.size(); ++n) {
        contact.node[n] = nodes[n].first;
        contact.weight[n] = static_cast<float>(nodes[n].second);
    }
    contact.normal = normal.normalized().cast<float>();
    contact.gap = static_cast<float>(gap);
    contact.lever = lever.cast<float>();
    return contact;
}

// Bodies, particles and the ground; points of bodies and particles against triangles, edges against edges, of many
// masses and with impulses carried in.
void build_surface_heap(Rig& rig, uint64_t seed) {
    Random random(seed);
    constexpr uint32_t kBodies = 6, kParticles = 24;
    const uint32_t ground = rig.fixed();
    std::vector<uint32_t> bodies, particles;
    for (uint32_t i = 0; i < kBodies; ++i) {
        const double mass = std::pow(10.0, 1.5 * random.unit());
        const Vec3 x = random.vector(), v = random.vector(), w = 4 * random.vector();
        bodies.push_back(rig.body(mass, mass * Vec3(0.1, 0.12, 0.15), x, random.rotation(), v, w));
        rig.w.nodes.before[bodies.back()].rotation = rig.w.nodes.motion[bodies.back()].q;
    }
    for (uint32_t i = 0; i < kParticles; ++i) {
        const double mass = std::pow(10.0, 1.5 * random.unit());
        const Vec3 x = random.vector();
        particles.push_back(rig.particle(mass, x, random.vector()));
    }
    const auto some = [&](uint32_t i) { return particles[(i + 7) % kParticles]; };
    for (uint32_t i = 0; i < 20; ++i) {
        const double s = random.unit(), t = random.unit() * (1 - s), u = random.unit();
        const uint32_t first = i % 4 == 0 ? bodies[i % kBodies] : i % 4 == 1 ? ground : some(5 * i);
        const uint32_t p = some(5 * i + 1), q = some(5 * i + 2), r = some(5 * i + 3);
        const Vec3 normal = random.vector(), lever = i % 4 == 0 ? Vec3(0.4 * random.vector()) : Vec3(Vec3::Zero());
        const double gap = random.between(-0.01, 0.01);
        SurfaceContact& contact = i % 4 == 3
                                      ? touch_surface(rig, {{first, s - 1}, {p, -s}, {q, u}, {r, 1 - u}}, normal, gap)
                                      : touch_surface(rig,
                                                      {{first, i % 2 ? 1.0 : -1.0},
                                                       {p, (i % 2 ? -1 : 1) * s},
                                                       {q, (i % 2 ? -1 : 1) * t},
                                                       {r, (i % 2 ? -1 : 1) * (1 - s - t)}},
                                                      normal, gap, lever);
        contact.friction = static_cast<float>(random.unit());
        contact.drive = random.vector().cast<float>();
        contact.skin = 0.3f * contact.lever;
        contact.force = {static_cast<float>(240 * random.unit()), static_cast<float>(30 * random.unit()),
                         static_cast<float>(-30 * random.unit())};
    }
}

Vec3 momentum_of(const Rig& rig) {
    Vec3 sum = Vec3::Zero();
    for (uint32_t node = 0; node < rig.w.nodes.slots(); ++node)
        sum += rig.w.nodes.mass[node].mass * rig.w.system.exact[rig.w.system.at(node)].v;
    return sum;
}

void expect_same_surfaces(const Rig& lanes, const Rig& rows) {
    double largest = 0;
    const auto& of_rows = rows.w.pairs.surfaces.contact;
    for (const SurfaceContact& contact : of_rows) largest = std::max(largest, double(contact.force.normal));
    ASSERT_GT(largest, 0);
    for (size_t i = 0; i < of_rows.size(); ++i) {
        const ContactForce &a = lanes.w.pairs.surfaces.contact[i].force, &b = of_rows[i].force;
        EXPECT_NEAR(a.normal, b.normal, 1e-4 * largest) << "contact " << i;
        EXPECT_NEAR(a.tangent1, b.tangent1, 1e-4 * largest) << "contact " << i;
        EXPECT_NEAR(a.tangent2, b.tangent2, 1e-4 * largest) << "contact " << i;
    }
    const Eigen::VectorXd u = velocities(lanes), v = velocities(rows);
    EXPECT_LE((u - v).norm(), 1e-4 * v.norm());
}

class SurfaceRows : public testing::TestWithParam<uint64_t> {
protected:
    void SetUp() override {
        Solver by_rows = kProjectedGaussSeidel;
        by_rows.lanes = false;
        for (Rig* rig : {&lanes, &rows}) {
            build_surface_heap(*rig, GetParam());
            rig->gravity.setZero();
            rig->settings.sweeps = 3;
            rig->begin(rig == &lanes ? kProjectedGaussSeidel : by_rows);
            rig->predict();
        }
        ASSERT_FALSE(lanes.w.system.surfaces.turning.empty());
        ASSERT_TRUE(rows.w.system.surfaces.group.empty());
        ASSERT_FALSE(validate_surfaces(lanes.w.partition, lanes.w.pairs.surfaces, lanes.w.nodes));
    }
    void solve_both() {
        for (Rig* rig : {&lanes, &rows}) {
            rig->solve();
            rig->store_contacts();
        }
    }
    Rig lanes, rows;
};
INSTANTIATE_TEST_SUITE_P(Seeds, SurfaceRows, testing::Range<uint64_t>(1, 31));

TEST_P(SurfaceRows, HaveTheImpulsesOfTheGenericRows) {
    solve_both();
    expect_same_surfaces(lanes, rows);
    for (Rig* rig : {&lanes, &rows}) {
        rig->move();
        rig->relax();
        rig->store_contacts();
    }
    expect_same_surfaces(lanes, rows);
}

// What the ground takes is the sum of its contacts' forces.
TEST_P(SurfaceRows, KeepMomentum) {
    const Vec3 before = momentum_of(lanes);
    std::vector<ContactForce> carried;
    for (const SurfaceContact& contact : lanes.w.pairs.surfaces.contact) carried.push_back(contact.force);
    solve_both();
    Vec3 given = Vec3::Zero();
    for (const SurfaceContact& contact : lanes.w.pairs.surfaces.contact) {
        if (lanes.w.nodes.info[contact.node[0]].kind != NodeKind::fixed) continue;
        const Vec3f t1 = tangent_of(contact.normal), t2 = contact.normal.cross(t1);
        const Vec3f f =
            contact.force.normal * contact.normal + contact.force.tangent1 * t1 + contact.force.tangent2 * t2;
        given -= lanes.h * double(contact.weight[0]) * f.cast<double>();
    }
    EXPECT_LE((momentum_of(lanes) - before - given).norm(), 1e-5 * before.norm());
}

// The planes of contacts stay, and gaps follow from where nodes are: in lanes by shifts, turned when levers turn, and
// in rows by poses.
TEST_P(SurfaceRows, FollowTheGapAsTheirNodesMove) {
    const auto point_of = [&](const SurfaceContact& contact) {
        Vec3 sum = Vec3::Zero();
        for (int n = 0; n < kMaxEnds; ++n) {
            const uint32_t node = contact.node[n];
            const NodeMotion& m = lanes.w.nodes.motion[node];
            const Vec3 core = (contact.lever - contact.skin).cast<double>();
            const Quat turn = m.q * lanes.w.nodes.before[node].rotation.conjugate();
            const Vec3 lever = n == 0 ? Vec3(turn * core + contact.skin.cast<double>()) : Vec3(Vec3::Zero());
            sum += double(contact.weight[n]) * (m.x + lever);
        }
        return sum;
    };
    const auto& contacts = lanes.w.pairs.surfaces.contact;
    std::vector<Vec3> began;
    for (const SurfaceContact& contact : contacts) began.push_back(point_of(contact));
    bool turned = false;
    for (int substep = 0; substep < 12; ++substep) {
        if (substep > 0) {
            lanes.predict();
            turn_surface_lanes(lanes.w.team, lanes.w.system, *lanes.settings.surface_kernels);
            turn_lanes(lanes.w.team, lanes.w.system, lanes.group(), *lanes.settings.kernels);
        }
        for (const uint8_t each : lanes.w.system.turned) turned = turned || each;
        lanes.solve();
        lanes.move();
        lanes.relax();
    }
    EXPECT_TRUE(turned);
    lanes.predict();
    Substep s = lanes.substep();
    sweep_biased(s);
    for (const SurfaceGroup& g : lanes.w.system.surfaces.group)
        for (int lane = 0; lane < kLanes; ++lane) {
            if (g.contact[lane] == kNoLanes) continue;
            const SurfaceContact& contact = contacts[g.contact[lane]];
            const Vec3 moved = point_of(contact) - began[g.contact[lane]];
            EXPECT_NEAR(g.gap[lane], double(contact.gap) + moved.dot(contact.normal.cast<double>()), 2e-6);
        }
}

// Where both sides are held but for a share of their weights, as at pinned corners that meet, what is free is not
// thrown by 1 / share times what the contact asks for.
TEST(SurfaceRow, OfHeldNodesThrowsNoOthers) {
    const auto speed_of = [](double share) {
        Rig rig;
        const uint32_t ground = rig.fixed(), other = rig.fixed();
        const uint32_t p = rig.particle(0.002, Vec3::Zero(), Vec3::Zero());
        const uint32_t q = rig.particle(0.01, Vec3::Zero(), Vec3::Zero());
        touch_surface(rig, {{ground, 1 - share}, {p, share}, {other, share - 1}, {q, -share}}, Vec3::UnitY(), -0.005);
        rig.gravity.setZero();
        rig.begin(kProjectedGaussSeidel);
        rig.predict();
        rig.solve();
        double most = 0;
        for (const uint32_t node : {p, q}) most = std::max(most, rig.w.system.exact[rig.w.system.at(node)].v.norm());
        return most;
    };
    const double asked = speed_of(1);
    EXPECT_GT(asked, 0.01);
    for (const double share : {1e-7, 1e-5, 1e-3, 0.01, 0.1, 0.5}) {
        EXPECT_LE(speed_of(share), 2 * asked) << share;
        EXPECT_GT(speed_of(share), 0.1 * asked) << share;
    }
}

// One contact above its surface is solved at once and exactly: the gap closes at the end of the substep.
TEST(SurfaceRow, HasTheEffectiveMassOfItsNodes) {
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        Rig rig;
        Random random(seed);
        rig.gravity.setZero();
        const Vec3 lever(0.3, -0.2, 0.25), normal = random.vector().normalized();
        const uint32_t box =
            rig.body(3, Vec3(0.1, 0.2, 0.25), Vec3::Zero(), random.rotation(), 4 * normal, random.vector());
        uint32_t corner[3];
        for (uint32_t& node : corner) node = rig.particle(0.1 + random.unit(), random.vector());
        SurfaceContact& contact =
            touch_surface(rig, {{box, -1}, {corner[0], 0.2}, {corner[1], 0.3}, {corner[2], 0.5}}, normal, 0.001, lever);
        contact.friction = 0;
        rig.settings.sweeps = 1;
        rig.begin(kProjectedGaussSeidel);
        rig.predict();
        rig.solve();
        const auto v = [&](uint32_t node) { return rig.w.system.exact[rig.w.system.at(node)]; };
        const Vec3 apart = 0.2 * v(corner[0]).v + 0.3 * v(corner[1]).v + 0.5 * v(corner[2]).v - v(box).v -
                           v(box).w.cross(contact.lever.cast<double>());
        EXPECT_NEAR(apart.dot(normal), -0.001 / rig.h, 1e-5) << "seed " << seed;
    }
}

// ---------------------------------------------------------------- blocks

// A triangle of particles tied by rods under load, and a box without ties: solved directly with the contact between
// them.
struct Drum : Rig {
    Drum() {
        gravity.setZero();
        const Vec3 at[] = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
        for (int i = 0; i < 3; ++i) corner[i] = particle(0.5, at[i]);
        for (int i = 0; i < 3; ++i)
            rod(corner[i], corner[(i + 1) % 3], Vec3::Zero(), Vec3::Zero(), i == 1 ? std::sqrt(2.0) : 1.0);
        for (Joint& joint : w.joints.record) joint.loaded = kLoadedAfter;
        box = body(2, Vec3(0.1, 0.2, 0.25), Vec3(0.3, 0.5, 0.3), Quat::Identity(), Vec3(0.7, -1, 0.2));
        touch_surface(*this, {{box, 1}, {corner[0], -0.4}, {corner[1], -0.3}, {corner[2], -0.3}}, Vec3::UnitY(), 0,
                      Vec3(0, -0.5, 0));
        contact().friction = 0.3f;
    }
    SurfaceContact& contact() { return w.pairs.surfaces.contact[0]; }
    void run(const Solver& with) {
        begin(with);
        predict();
        solve();
        move();
        relax();
        store_contacts();
    }
    uint32_t corner[3], box;
};

TEST(SurfaceBlock, TakesInTheContactAndWhatItTouches) {
    Drum drum;
    drum.run(kBlockLdlt);
    ASSERT_EQ(drum.w.partition.blocks.size(), 1u);
    EXPECT_EQ(drum.w.partition.blocks[0].nodes.size(), 4u);
    EXPECT_EQ(drum.w.partition.blocks[0].surfaces.size(), 1u);
    EXPECT_TRUE(drum.contact().in_block);
    EXPECT_TRUE(drum.w.system.surfaces.group.empty());
    EXPECT_FALSE(validate_surfaces(drum.w.partition, drum.w.pairs.surfaces, drum.w.nodes));
    const auto& m = drum.w.nodes.motion;
    Vec3 sum = 2.0 * m[drum.box].v;
    for (const uint32_t node : drum.corner) sum += 0.5 * m[node].v;
    EXPECT_LE((sum - 2 * Vec3(0.7, -1, 0.2)).norm(), 1e-7);
    Vec3 apart = m[drum.box].v + m[drum.box].w.cross(Vec3(0, -0.5, 0));
    const double weight[] = {0.4, 0.3, 0.3};
    for (int i = 0; i < 3; ++i) apart -= weight[i] * m[drum.corner[i]].v;
    EXPECT_NEAR(apart.y(), 0, 1e-4);
    const ContactForce& force = drum.contact().force;
    EXPECT_GT(force.normal, 0);
    EXPECT_NEAR(std::hypot(force.tangent1, force.tangent2), 0.3 * force.normal, 0.1 * force.normal);
}

// Swept, the same contact is solved with what the rods leave to it.
TEST(SurfaceBlock, AgreesWithManySweeps) {
    Drum direct, swept;
    for (Drum* each : {&direct, &swept}) each->contact().friction = 0;
    swept.settings.sweeps = 400;
    direct.run(kBlockLdlt);
    swept.run(kProjectedGaussSeidel);
    EXPECT_EQ(swept.w.system.surfaces.group.size(), 1u);
    EXPECT_NEAR(direct.contact().force.normal, swept.contact().force.normal, 0.02 * direct.contact().force.normal);
}

}  // namespace
}  // namespace taut::test
