// A world's own limits: one more is refused with a text and changes nothing; contacts beyond theirs are dropped, the
// shallowest first, and counted.
#include <vector>

#include "support.h"

using namespace taut_test;

namespace {

struct Limits {
    uint32_t bodies = 0, colliders = 0, joints = 0, contacts = 0;
};

class LimitedWorld {
public:
    explicit LimitedWorld(const Limits& limits) {
        taut_world_def def;
        taut_world_def_init(&def);
        EXPECT_EQ(def.max_bodies + def.max_colliders + def.max_joints + def.max_contacts, 0u) << "no limits by default";
        def.max_bodies = limits.bodies;
        def.max_colliders = limits.colliders;
        def.max_joints = limits.joints;
        def.max_contacts = limits.contacts;
        EXPECT_OK(taut_world_create(&def, &world));
    }
    ~LimitedWorld() { taut_world_destroy(world); }
    LimitedWorld(const LimitedWorld&) = delete;
    LimitedWorld& operator=(const LimitedWorld&) = delete;

    taut_world world{};
};

// call() is refused, naming the field and its value, and changes nothing.
template <class Call>
void expect_limit(taut_world world, const char* field, Call&& call) {
    const Watch watch(world);
    EXPECT_EQ(call(), TAUT_LIMIT);
    EXPECT_TRUE(contains(taut_last_error(), field)) << taut_last_error();
    EXPECT_TRUE(watch.unchanged());
}

taut_result try_body(taut_world world, const taut_body_def& def) {
    taut_body body{};
    return taut_world_add_body(world, &def, &body);
}

TEST(Limit, OfBodiesHoldsUntilOneIsRemoved) {
    const LimitedWorld limited({.bodies = 3});
    const taut_world world = limited.world;
    const taut_body_def def = body_def(TAUT_BODY_DYNAMIC, add_box(world));
    const taut_body first = add_body(world, def);
    add_body(world, def);
    add_particle(world, 5, 5, 5);
    expect_limit(world, "max_bodies of the world is 3", [&] { return try_body(world, def); });
    expect_limit(world, "max_bodies of the world is 3", [&] {
        taut_particle_def particle;
        taut_particle_def_init(&particle);
        taut_body body{};
        return taut_world_add_particle(world, &particle, &body);
    });
    ASSERT_OK(taut_body_remove(first));
    EXPECT_OK(try_body(world, def));
}

TEST(Limit, OfColliders) {
    const LimitedWorld limited({.colliders = 2});
    const taut_world world = limited.world;
    const taut_shape box = add_box(world);
    const taut_body body = add_body(world, body_def(TAUT_BODY_DYNAMIC, box));
    taut_collider_def part;
    taut_collider_def_init(&part);
    part.shape = box;
    taut_collider out{};
    taut_body_def two = body_def(TAUT_BODY_DYNAMIC, box, 3);
    two.colliders = &part;
    two.collider_count = 1;
    expect_limit(world, "max_colliders of the world is 2", [&] { return try_body(world, two); });
    ASSERT_OK(taut_body_add_collider(body, &part, &out));
    expect_limit(world, "max_colliders of the world is 2", [&] { return taut_body_add_collider(body, &part, &out); });
    EXPECT_OK(try_body(world, body_def(TAUT_BODY_STATIC, {}, 6))) << "a body without a collider has room";
}

TEST(Limit, OfJoints) {
    const LimitedWorld limited({.joints = 1});
    const taut_world world = limited.world;
    const taut_body body = add_body(world, body_def(TAUT_BODY_DYNAMIC, add_box(world)));
    const taut_joint first = add_ball(world, body, {0});
    taut_ball_joint_def def;
    taut_ball_joint_def_init(&def);
    def.base.body_a = body;
    taut_joint out{};
    expect_limit(world, "max_joints of the world is 1", [&] { return taut_world_add_ball_joint(world, &def, &out); });
    ASSERT_OK(taut_joint_remove(first));
    EXPECT_OK(taut_world_add_ball_joint(world, &def, &out));
}

struct CableCase {
    taut_cable_kind kind;
    float bending_stiffness;
    bool clamped;
};

class LimitOfCables : public testing::TestWithParam<CableCase> {
protected:
    static taut_cable_def def(const taut_pos* points) {
        taut_cable_def cable;
        taut_cable_def_init(&cable);
        cable.kind = GetParam().kind;
        cable.bending_stiffness = GetParam().bending_stiffness;
        cable.points = points;
        cable.point_count = 2;
        cable.segment_count = 8;
        cable.end[0].attached = 1;
        cable.end[0].clamped = GetParam().clamped ? 1 : 0;
        cable.end[0].anchor = points[0];
        return cable;
    }
    static constexpr taut_pos kPoints[2] = {{0, 5, 0}, {4, 5, 0}};
};

// A cable fits exactly, or not at all: every part of it counts.
TEST_P(LimitOfCables, CountsTheirParts) {
    const taut_cable_def cable = def(kPoints);
    taut_cable out{};
    Counts needed;
    {
        const LimitedWorld free({});
        ASSERT_OK(taut_world_add_cable(free.world, &cable, &out));
        needed = counts_of(free.world);
    }
    const LimitedWorld enough({.bodies = needed.bodies, .colliders = 8, .joints = needed.joints});
    EXPECT_OK(taut_world_add_cable(enough.world, &cable, &out));
    const LimitedWorld bodies({.bodies = needed.bodies - 1});
    expect_limit(bodies.world, "max_bodies", [&] { return taut_world_add_cable(bodies.world, &cable, &out); });
    const LimitedWorld colliders({.colliders = 7});
    expect_limit(colliders.world, "max_colliders", [&] { return taut_world_add_cable(colliders.world, &cable, &out); });
    if (needed.joints == 1) return;  // a limit of 0 is none
    const LimitedWorld joints({.joints = needed.joints - 1});
    expect_limit(joints.world, "max_joints", [&] { return taut_world_add_cable(joints.world, &cable, &out); });
}

INSTANTIATE_TEST_SUITE_P(Kinds, LimitOfCables,
                         testing::Values(CableCase{TAUT_CABLE_LINKS, 0, false}, CableCase{TAUT_CABLE_LINKS, 10, true},
                                         CableCase{TAUT_CABLE_PARTICLES, 0, false},
                                         CableCase{TAUT_CABLE_PARTICLES, 10, true}));

// Boxes that overlap the ground by 1, 2, 3 ... mm, the deepest created first or last.
class SunkBoxes {
public:
    SunkBoxes(uint32_t max_contacts, bool deepest_first) : limited_({.contacts = max_contacts}) {
        const taut_world world = limited_.world;
        add_body(world, body_def(TAUT_BODY_STATIC, add_plane(world)));
        const taut_shape box = add_box(world);
        for (int i = 0; i < kBoxes; ++i) {
            const int mm = deepest_first ? kBoxes - i : i + 1;
            depth_.push_back(mm);
            boxes_.push_back(add_body(world, body_def(TAUT_BODY_DYNAMIC, box, 3 * i, 0.5 - 1e-3 * mm, 0)));
        }
        EXPECT_OK(taut_world_step(world));
    }
    taut_world world() const { return limited_.world; }
    taut_events events() const {
        taut_events out{};
        EXPECT_OK(taut_world_get_events(world(), &out));
        return out;
    }
    // Those that are not solved fall freely.
    std::vector<int> falling() const {
        std::vector<int> depths;
        for (size_t i = 0; i < boxes_.size(); ++i) {
            taut_vec3 v{}, w{};
            EXPECT_OK(taut_body_get_velocity(boxes_[i], &v, &w));
            if (v.y < -0.9f * 9.81f / 60) depths.push_back(depth_[i]);
        }
        return depths;
    }

    static constexpr int kBoxes = 6;

private:
    LimitedWorld limited_;
    std::vector<taut_body> boxes_;
    std::vector<int> depth_;  // [mm]
};

TEST(LimitOfContacts, KeepsTheDeepestInAnyOrderOfCreation) {
    EXPECT_EQ(SunkBoxes(4, false).falling(), (std::vector<int>{1, 2}));
    EXPECT_EQ(SunkBoxes(4, true).falling(), (std::vector<int>{2, 1}));
    EXPECT_EQ(SunkBoxes(SunkBoxes::kBoxes, true).falling(), std::vector<int>{});
}

TEST(LimitOfContacts, IsToldByEventsAndProfileAndLog) {
    const SunkBoxes boxes(4, false);
    const taut_events events = boxes.events();
    EXPECT_EQ(events.dropped_contacts, 2u);
    EXPECT_EQ(events.begin_count, 4u) << "what is dropped does not touch";
    taut_profile profile{};
    profile.struct_size = sizeof profile;
    ASSERT_OK(taut_world_get_profile(boxes.world(), &profile));
    EXPECT_EQ(profile.dropped_contacts, 2u);
    EXPECT_EQ(profile.touching, 4u);
    EXPECT_EQ(SunkBoxes(SunkBoxes::kBoxes, false).events().dropped_contacts, 0u);
}

// Of equally deep ones the first created stays; over many steps it is the same one, and a touch that is dropped ends.
TEST(LimitOfContacts, EndsATouchThatIsDropped) {
    const LimitedWorld limited({.contacts = 1});
    const taut_world world = limited.world;
    add_body(world, body_def(TAUT_BODY_STATIC, add_plane(world)));
    const taut_shape box = add_box(world);
    add_body(world, body_def(TAUT_BODY_DYNAMIC, box, 0, 0.499));
    taut_events events{};
    for (int i = 0; i < 5; ++i) ASSERT_OK(taut_world_step(world));
    ASSERT_OK(taut_world_get_events(world, &events));
    EXPECT_EQ(events.begin_count, 1u);
    const taut_body deep = add_body(world, body_def(TAUT_BODY_DYNAMIC, box, 5, 0.45));
    ASSERT_OK(taut_world_step(world));
    ASSERT_OK(taut_world_get_events(world, &events));
    EXPECT_EQ(events.dropped_contacts, 1u);
    ASSERT_EQ(events.end_count, 1u);
    ASSERT_EQ(events.begin_count, 1u);
    EXPECT_EQ(events.begin[0].body_b.bits, deep.bits);
}

// The same bits on any number of threads, and none lost without a count.
TEST(LimitOfContacts, GivesTheSameBitsOnTeams) {
    std::vector<uint64_t> hashes;
    for (uint32_t threads : {1u, 2u, 5u}) {
        taut_world_def def;
        taut_world_def_init(&def);
        def.threads = threads;
        def.max_contacts = 100;
        taut_world world{};
        ASSERT_OK(taut_world_create(&def, &world));
        add_body(world, body_def(TAUT_BODY_STATIC, add_plane(world)));
        const taut_shape box = add_box(world);
        for (int i = 0; i < 216; ++i)
            add_body(world, body_def(TAUT_BODY_DYNAMIC, box, i % 6, 0.6 + 1.01 * (i / 36), i / 6 % 6));
        uint32_t most = 0;
        for (int step = 0; step < 60; ++step) {
            ASSERT_OK(taut_world_step(world));
            taut_events events{};
            ASSERT_OK(taut_world_get_events(world, &events));
            most = std::max(most, events.dropped_contacts);
        }
        EXPECT_GT(most, 0u);
        hashes.push_back(hash_of(world));
        ASSERT_OK(taut_world_destroy(world));
    }
    EXPECT_EQ(hashes[1], hashes[0]);
    EXPECT_EQ(hashes[2], hashes[0]);
}

}  // namespace
