// Sensors against exact geometry, the query interface and a list kept beside them.
#include <random>
#include <set>

#include "physics/contact_lab.h"
#include "physics/surface_lab.h"

namespace {

using namespace lab;

taut_body add_sensor(const World& world, taut_body_kind kind, taut_shape shape, const Vec& position,
                     uint32_t flags = TAUT_COLLIDER_SENSOR) {
    taut_body_def def;
    taut_body_def_init(&def);
    def.kind = kind;
    def.position = position.pos();
    def.shape = shape;
    def.collider_flags = flags;
    def.gravity_scale = 0;
    if (kind == TAUT_BODY_DYNAMIC) {
        def.mass = 1;
        def.inertia = {1, 1, 1, 0, 0, 0};
    }
    taut_body out{};
    ok(taut_world_add_body(world.handle, &def, &out));
    return out;
}

std::set<uint64_t> overlaps_of(taut_collider sensor) {
    uint32_t count = 0;
    taut_collider_get_overlaps(sensor, nullptr, 0, &count);
    std::vector<taut_collider> found(count);
    ok(taut_collider_get_overlaps(sensor, found.data(), count, &count));
    std::set<uint64_t> out;
    for (const taut_collider each : found) out.insert(each.bits);
    EXPECT_EQ(out.size(), found.size());
    return out;
}

class SensorOn : public testing::TestWithParam<taut_body_kind> {};

// A ball of radius 0.25 goes along x through a box of half a metre: it overlaps while |x| <= 0.75.
TEST_P(SensorOn, DetectsABallJustWhileItOverlaps) {
    World world;
    const taut_body gate = add_sensor(world, GetParam(), world.box({0.5, 0.5, 0.5}), {0, 0, 0});
    const taut_body ball =
        world.add({.kind = TAUT_BODY_KINEMATIC, .shape = world.sphere(0.25), .position = {-2, 0, 0}});
    ok(taut_body_set_velocity(ball, {1.234f, 0, 0}, {0, 0, 0}));
    bool inside = false;
    int entered = 0, left = 0;
    while (position(ball).x < 2) {
        world.step();
        const bool now = std::abs(position(ball).x) <= 0.75;
        const taut_events e = events_of(world);
        EXPECT_EQ(e.sensor_enter_count, now && !inside ? 1u : 0u) << position(ball).x;
        EXPECT_EQ(e.sensor_leave_count, !now && inside ? 1u : 0u) << position(ball).x;
        EXPECT_EQ(overlaps_of(collider_of(gate)).size(), now ? 1u : 0u) << position(ball).x;
        for (uint32_t i = 0; i < e.sensor_enter_count; ++i) {
            EXPECT_EQ(e.sensor_enter[i].sensor_body.bits, gate.bits);
            EXPECT_EQ(e.sensor_enter[i].visitor.bits, collider_of(ball).bits);
        }
        entered += static_cast<int>(e.sensor_enter_count);
        left += static_cast<int>(e.sensor_leave_count);
        inside = now;
    }
    EXPECT_EQ(entered, 1);
    EXPECT_EQ(left, 1);
    EXPECT_EQ(norm(position(gate)), 0) << "a sensor was pushed";
}

INSTANTIATE_TEST_SUITE_P(Each, SensorOn, testing::Values(TAUT_BODY_STATIC, TAUT_BODY_KINEMATIC, TAUT_BODY_DYNAMIC));

TEST(Sensor, DetectsWhatItsRuleSays) {
    World world;
    const taut_shape box = world.box({0.5, 0.5, 0.5}), ball = world.sphere(0.3);
    const taut_body plain = add_sensor(world, TAUT_BODY_STATIC, box, {0, 0, 0});
    const taut_body other =
        add_sensor(world, TAUT_BODY_KINEMATIC, box, {0.2, 0, 0}, TAUT_COLLIDER_SENSOR | TAUT_COLLIDER_SENSES_STATIC);
    const taut_shape floor = mesh(world, {{{-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}}, {0, 1, 2, 0, 2, 3}});
    const taut_body ground = world.add({.kind = TAUT_BODY_STATIC, .shape = floor});
    const taut_body wall = world.add({.kind = TAUT_BODY_STATIC, .shape = world.plane(), .position = {0, 0.1, 0}});
    const taut_body moving = world.add({.kind = TAUT_BODY_KINEMATIC, .shape = ball});
    const taut_body falling = world.add({.shape = ball, .position = {0.1, 0.3, 0}, .gravity_scale = 0, .group = -1});
    taut_particle_def grain;
    taut_particle_def_init(&grain);
    grain.shape = ball;
    grain.gravity_scale = 0;
    grain.position = {0, 0.2, 0.6};
    grain.filter.group = -1;
    taut_body particle{};
    ok(taut_world_add_particle(world.handle, &grain, &particle));
    for (const taut_body body : {falling, particle}) {  // let them lie still
        const taut_filter apart{2, 1, 0, 0};
        ok(taut_collider_set_filter(collider_of(body), &apart));
    }
    for (const taut_body body : {ground, wall, moving}) {
        const taut_filter apart{4, 1, 0, 0};
        ok(taut_collider_set_filter(collider_of(body), &apart));
    }
    world.step();
    const auto bits = [](taut_body body) { return collider_of(body).bits; };
    EXPECT_EQ(overlaps_of(collider_of(plain)), (std::set{bits(moving), bits(falling), bits(particle)}));
    EXPECT_EQ(overlaps_of(collider_of(other)),
              (std::set{bits(moving), bits(falling), bits(particle), bits(ground), bits(wall)}));
    EXPECT_TRUE(world.contacts().empty());
}

TEST(Sensor, HasNoMassAndIsSeenByQueriesThatAsk) {
    World world;
    const taut_shape box = world.box({0.5, 0.5, 0.5});
    const taut_body body = world.add({.shape = box, .gravity_scale = 0});
    taut_collider_def def;
    taut_collider_def_init(&def);
    def.shape = box;
    def.position = {2, 0, 0};
    def.flags = TAUT_COLLIDER_SENSOR;
    taut_collider sensor{};
    ok(taut_body_add_collider(body, &def, &sensor));
    const double mass = mass_of(body).mass;
    ok(taut_body_set_mass_from_colliders(body));
    EXPECT_EQ(mass_of(body).mass, mass);
    const taut_ray ray{{2, 5, 0}, {0, -10, 0}, 0};
    taut_query_hit hit{};
    ok(taut_world_cast_ray(world.handle, &ray, nullptr, &hit));
    EXPECT_EQ(hit.body.bits, 0u);
    taut_query_filter filter;
    taut_query_filter_init(&filter);
    filter.kinds |= TAUT_QUERY_SENSOR;
    ok(taut_world_cast_ray(world.handle, &ray, &filter, &hit));
    EXPECT_EQ(hit.collider.bits, sensor.bits);
    taut_collider_def back;
    ok(taut_collider_get_def(sensor, &back));
    EXPECT_EQ(back.flags, TAUT_COLLIDER_SENSOR);
}

// Sensors in a pile change no bit of its motion, its contacts and its islands.
TEST(Sensor, IsSolvedWithNobody) {
    Vec where[2];
    uint32_t islands[2];
    for (int with = 0; with < 2; ++with) {
        World world;
        world.add_ground();
        const taut_shape box = world.box({0.25, 0.25, 0.25});
        std::vector<taut_body> bodies;
        for (int i = 0; i < 30; ++i)
            bodies.push_back(world.add({.shape = box, .position = {0.4 * (i % 5), 1 + 0.6 * (i / 5), 0.1 * i}}));
        if (with) add_sensor(world, TAUT_BODY_STATIC, world.box({3, 1, 3}), {1, 0.5, 1});
        world.step(100);
        where[with] = position(bodies[17]);
        islands[with] = world.profile().islands;
    }
    EXPECT_EQ(norm(where[1] - where[0]), 0);
    EXPECT_EQ(islands[1], islands[0]);
}

// Turning a sensor on ends contacts, turning it off ends visits.
TEST(Sensor, IsSwitchedAtRunTime) {
    World world;
    const taut_body floor =
        world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({2, 0.5, 2}), .position = {0, -0.5, 0}});
    const taut_body ball = world.add({.shape = world.sphere(0.25), .position = {0, 0.25, 0}});
    world.step(30);
    ASSERT_EQ(world.contacts().size(), 1u);
    ok(taut_collider_set_sensor(collider_of(floor), 1));
    world.step(5);
    EXPECT_EQ(overlaps_of(collider_of(floor)).size(), 1u);
    EXPECT_LT(velocity(ball).y, -0.5);
    ok(taut_collider_set_sensor(collider_of(floor), 0));
    EXPECT_TRUE(overlaps_of(collider_of(floor)).empty());
    EXPECT_EQ(events_of(world).end_count, 1u);
    world.step();
    EXPECT_EQ(events_of(world).sensor_leave_count, 1u);
    EXPECT_EQ(events_of(world).begin_count, 1u);
}

// Random operations on bodies, colliders, filters and switches; after each step the visits are those that queries find,
// and every enter and leave changes a list kept here.
class Zoo {
public:
    explicit Zoo(uint32_t seed, uint32_t threads)
        : world_([=](taut_world_def& def) { def.threads = threads; }), random_(seed) {
        shapes_ = {world_.box({0.4, 0.6, 0.5}), world_.sphere(0.5), world_.box({1.5, 0.2, 1}), world_.sphere(1.2)};
        world_.add({.kind = TAUT_BODY_STATIC, .shape = world_.plane(), .position = {0, -4, 0}});
    }

    void operate() {
        if (bodies_.size() < 12 || (below(3) == 0 && bodies_.size() < 40)) return add();
        const size_t which = below(bodies_.size());
        const taut_body body = bodies_[which];
        const taut_collider collider = collider_of(body);
        const taut_filter filters[] = {{1, UINT64_MAX, 0, 0}, {2, 1, 0, 0}, {1, 1, -3, 0}, {1, 2, 3, 0}};
        const taut_pose pose = {place().pos(), {0, 0, 0, 1}, {0, 0}};
        taut_collider second{};
        taut_collider_def def;
        taut_collider_def_init(&def);
        def.shape = shapes_[below(4)];
        switch (below(7)) {
            case 0:
                ok(taut_body_remove(body)), bodies_.erase(bodies_.begin() + static_cast<long>(which));
                break;
            case 1:
                ok(taut_collider_set_sensor(collider, below(2)));
                break;
            case 2:
                ok(taut_collider_set_filter(collider, &filters[below(4)]));
                break;
            case 3:
                ok(taut_body_set_pose(body, &pose));
                break;
            case 4:
                ok(taut_collider_set_shape(collider, shapes_[below(4)], {0, 0, 0}, {0, 0, 0, 1}));
                break;
            case 5:
                ok(taut_body_add_collider(body, &def, &second)), ok(taut_collider_remove(collider));
                break;
            default:
                world_.step(), check();
                break;
        }
    }

    const std::vector<uint64_t>& told() const { return told_; }
    size_t visits = 0;

private:
    size_t below(size_t n) { return random_() % n; }
    double coordinate() { return 0.01 * static_cast<double>(below(600)) - 3; }
    Vec place() { return {coordinate(), coordinate(), coordinate()}; }

    void add() {
        const taut_body_kind kinds[] = {TAUT_BODY_STATIC, TAUT_BODY_KINEMATIC, TAUT_BODY_DYNAMIC, TAUT_BODY_DYNAMIC};
        const uint32_t flags[] = {0, 0, TAUT_COLLIDER_SENSOR, TAUT_COLLIDER_SENSOR | TAUT_COLLIDER_SENSES_STATIC};
        bodies_.push_back(add_sensor(world_, kinds[below(4)], shapes_[below(4)], place(), flags[below(4)]));
        taut_body_kind kind;
        ok(taut_body_get_kind(bodies_.back(), &kind));
        if (kind != TAUT_BODY_STATIC) ok(taut_body_set_velocity(bodies_.back(), (5.0 * place()).narrow(), {1, 2, 3}));
    }

    void check() {
        const taut_events e = events_of(world_);
        const auto key = [](const taut_sensor_event& v) { return std::pair{v.sensor.bits, v.visitor.bits}; };
        for (const auto& [list, count] :
             {std::pair{e.sensor_leave, e.sensor_leave_count}, std::pair{e.sensor_enter, e.sensor_enter_count}})
            for (uint32_t i = 0; i < count; ++i) {
                ASSERT_TRUE(i == 0 || key(list[i - 1]) < key(list[i]));
                told_.insert(told_.end(), {key(list[i]).first >> 24, key(list[i]).second >> 24});  // without the world
            }
        for (uint32_t i = 0; i < e.sensor_leave_count; ++i) ASSERT_EQ(inside_.erase(key(e.sensor_leave[i])), 1u);
        for (uint32_t i = 0; i < e.sensor_enter_count; ++i) ASSERT_TRUE(inside_.insert(key(e.sensor_enter[i])).second);
        visits += e.sensor_enter_count;
        std::set<std::pair<uint64_t, uint64_t>> expected;
        for (const taut_body body : bodies_) add_expected(collider_of(body), body, expected);
        ASSERT_EQ(inside_, expected);
    }

    static bool agree(const taut_filter& a, const taut_filter& b) {
        if (a.group != 0 && a.group == b.group) return a.group > 0;
        return (a.category & b.mask) != 0 && (b.category & a.mask) != 0;
    }

    // By a query with the sensor's shape, and the rules as the header states them.
    void add_expected(taut_collider sensor, taut_body body, std::set<std::pair<uint64_t, uint64_t>>& out) {
        taut_collider_def def, other;
        ok(taut_collider_get_def(sensor, &def));
        if (!(def.flags & TAUT_COLLIDER_SENSOR)) {
            EXPECT_TRUE(overlaps_of(sensor).empty());
            return;
        }
        taut_pose pose{};
        ok(taut_body_get_pose(body, &pose));
        taut_collider found[64];
        uint32_t count = 0;
        ok(taut_world_overlap_shape(world_.handle, def.shape, &pose, nullptr, found, 64, &count));
        std::set<uint64_t> mine;
        for (uint32_t i = 0; i < count; ++i) {
            ok(taut_collider_get_def(found[i], &other));
            taut_body owner{};
            ok(taut_collider_get_body(found[i], &owner));
            taut_body_kind kind;
            ok(taut_body_get_kind(owner, &kind));
            if (owner.bits == body.bits || !agree(def.filter, other.filter)) continue;
            if (kind == TAUT_BODY_STATIC && !(def.flags & TAUT_COLLIDER_SENSES_STATIC)) continue;
            mine.insert(found[i].bits);
            out.insert({sensor.bits, found[i].bits});
        }
        EXPECT_EQ(overlaps_of(sensor), mine);
    }

    World world_;
    std::mt19937 random_;
    std::vector<taut_shape> shapes_;
    std::vector<taut_body> bodies_;
    std::set<std::pair<uint64_t, uint64_t>> inside_;
    std::vector<uint64_t> told_;
};

TEST(Sensor, EveryLeaveHasItsEnterUnderTenThousandOperations) {
    std::vector<uint64_t> first;
    for (uint32_t threads : {1u, 3u}) {
        Zoo zoo(20240607, threads);
        for (int i = 0; i < 10000 && !testing::Test::HasFailure(); ++i) zoo.operate();
        EXPECT_GT(zoo.visits, 1000u);
        if (threads == 1) first = zoo.told();
        EXPECT_EQ(zoo.told(), first) << threads << " threads";
    }
}

TEST(Sensor, TakesNoMemoryAfterWarmUp) {
    World world;
    world.add_ground();
    add_sensor(world, TAUT_BODY_STATIC, world.box({2, 1, 2}), {0, 1, 0});
    const taut_shape ball = world.sphere(0.2);
    std::vector<taut_body> balls;
    for (int i = 0; i < 20; ++i)
        balls.push_back(world.add({.kind = TAUT_BODY_KINEMATIC, .shape = ball, .position = {0.1 * i - 1, 1, 0}}));
    uint32_t changes = 0;
    for (int i = 0; i < 400; ++i) {
        for (const taut_body each : balls) {
            const double turn = 0.05 * i + 0.3 * static_cast<double>(each.bits >> 40);
            ok(taut_body_set_velocity(each, Vec(4 * std::cos(turn), 0, 4 * std::sin(turn)).narrow(), {0, 0, 0}));
        }
        world.step();
        const taut_events e = events_of(world);
        if (i < 200) continue;
        changes += e.sensor_enter_count + e.sensor_leave_count;
        EXPECT_EQ(world.profile().allocations, 0u);
    }
    EXPECT_GT(changes, 20u);
}

}  // namespace
