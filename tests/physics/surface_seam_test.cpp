// Bodies that slide and roll over flat surfaces of many triangles go as over a plane: seams catch nothing.
#include <ostream>

#include "physics/surface_lab.h"

namespace {

using namespace lab;

enum class Floor { plane, grid, voxels, height_field };
enum class Slider { box, sphere, capsule, stone };

struct Course {
    Floor floor;
    Slider slider;
    double speed;    // [m/s]
    double heading;  // of the floor's triangles against the course [rad]

    friend std::ostream& operator<<(std::ostream& out, const Course& c) {
        constexpr const char* kFloors[] = {"plane", "grid", "voxels", "height field"};
        constexpr const char* kSliders[] = {"box", "sphere", "capsule", "stone"};
        return out << kSliders[static_cast<int>(c.slider)] << " on " << kFloors[static_cast<int>(c.floor)] << " at "
                   << c.speed << " m/s, heading " << c.heading;
    }
};

constexpr double kSide = 26, kCell = 0.4;  // [m]

// A square about the origin, turned by the heading.
taut_body add_floor(const World& world, Floor floor, double heading, double friction) {
    if (floor == Floor::plane) return world.add_ground(friction);
    taut_shape shape{};
    if (floor == Floor::grid) shape = mesh(world, grid(kSide, kSide, kCell));
    if (floor == Floor::voxels) shape = mesh(world, voxels(kSide, kSide, kCell));
    if (floor == Floor::height_field) shape = height_field(world, 66, 66, kCell, [](double, double) { return 0; });
    const Quat turn = Quat::turn({0, 1, 0}, heading);
    return world.add({.kind = TAUT_BODY_STATIC,
                      .shape = shape,
                      .position = turn.rotate({-kSide / 2, 0, -kSide / 2}),
                      .rotation = turn,
                      .friction = friction});
}

BodyPlan plan_of(const World& world, Slider slider) {
    switch (slider) {
        case Slider::box:
            return {.shape = world.box({0.5, 0.2, 0.3}), .position = {-6, 0.2, 0}};
        case Slider::sphere:
            return {.shape = world.sphere(0.3), .position = {-6, 0.3, 0}};
        case Slider::capsule:
            return {.shape = world.capsule(0.2, 0.4),
                    .position = {-6, 0.2, 0},
                    .rotation = Quat::turn({1, 0, 0}, 1.5707963)};
        default:
            return {.shape = stone(world), .position = {-6, 0.2, 0}};
    }
}

struct Ride {
    double speed_lost = 0;  // share of the first
    double bump = 0;        // largest vertical speed [m/s]
    double aside = 0;       // of the straight course [m]
    double turned = 0;      // largest spin [rad/s]
    double points = 0;      // mean number of contact points
};

// Ten metres along x.
Ride slide(const Course& course) {
    World world;
    add_floor(world, course.floor, course.heading, 0);
    BodyPlan plan = plan_of(world, course.slider);
    plan.friction = 0;
    const taut_body body = world.add(plan);
    world.step(20);
    ok(taut_body_set_velocity(body, Vec(course.speed, 0, 0).narrow(), Vec().narrow()));
    Ride ride;
    int frames = 0;
    for (; position(body).x < 4 && frames < 1200; ++frames) {
        world.step();
        const BodyState s = state(body);
        ride.bump = std::max(ride.bump, std::abs(s.velocity.y));
        ride.aside = std::max(ride.aside, std::abs(s.position.z));
        ride.turned = std::max(ride.turned, norm(s.spin));
        ride.points += static_cast<double>(world.contacts().size());
    }
    ride.points /= frames;
    ride.speed_lost = 1 - velocity(body).x / course.speed;
    return ride;
}

class Seams : public testing::TestWithParam<Course> {};

TEST_P(Seams, CatchNothing) {
    const Ride ride = slide(GetParam());
    RecordProperty("lost", std::to_string(ride.speed_lost));
    RecordProperty("bump", std::to_string(ride.bump));
    RecordProperty("points", std::to_string(ride.points));
    EXPECT_LT(std::abs(ride.speed_lost), 1e-4);
    EXPECT_LT(ride.bump, 1e-3);
    EXPECT_LT(ride.aside, 1e-3);
    EXPECT_LT(ride.turned, 1e-2);
}

std::vector<Course> courses() {
    std::vector<Course> out;
    for (Floor floor : {Floor::plane, Floor::grid, Floor::voxels, Floor::height_field})
        for (Slider slider : {Slider::box, Slider::sphere, Slider::capsule, Slider::stone})
            for (const auto& [speed, heading] : {std::pair(1.0, 0.0), std::pair(5.0, 0.3), std::pair(20.0, 0.7854)})
                out.push_back({floor, slider, speed, heading});
    return out;
}

INSTANTIATE_TEST_SUITE_P(Flat, Seams, testing::ValuesIn(courses()));

}  // namespace
