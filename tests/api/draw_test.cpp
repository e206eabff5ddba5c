// Pictures of a world: what is drawn lies where the shapes, contacts and joints are.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "support.h"

using namespace taut_test;

namespace {

struct Picture {
    std::vector<taut_draw_line> lines;
    std::vector<taut_draw_triangle> triangles;
    std::vector<taut_draw_label> labels;
};

taut_draw_def def_of(uint32_t what) {
    taut_draw_def def;
    taut_draw_def_init(&def);
    def.what = what;
    return def;
}

Picture draw(taut_world world, const taut_draw_def& def) {
    taut_drawing drawing;
    taut_drawing_init(&drawing);
    const taut_result asked = taut_world_draw(world, &def, &drawing);
    EXPECT_TRUE(asked == TAUT_OK || asked == TAUT_TOO_SMALL) << taut_last_error();
    Picture out;
    out.lines.resize(drawing.line_count);
    out.triangles.resize(drawing.triangle_count);
    out.labels.resize(drawing.label_count);
    drawing.lines = out.lines.data(), drawing.line_capacity = drawing.line_count;
    drawing.triangles = out.triangles.data(), drawing.triangle_capacity = drawing.triangle_count;
    drawing.labels = out.labels.data(), drawing.label_capacity = drawing.label_count;
    EXPECT_OK(taut_world_draw(world, &def, &drawing));
    return out;
}
Picture draw(taut_world world, uint32_t what) { return draw(world, def_of(what)); }

double length(const taut_draw_line& line) {
    return std::hypot(line.to.x - line.from.x, line.to.y - line.from.y, line.to.z - line.from.z);
}

// Of what triangles enclose, by the divergence theorem: a sixth of the sum of a . (b x c).
double volume(const std::vector<taut_draw_triangle>& triangles) {
    double sum = 0;
    for (const taut_draw_triangle& t : triangles) {
        const taut_pos &a = t.corners[0], &b = t.corners[1], &c = t.corners[2];
        sum += a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
    }
    return sum / 6;
}

enum class Solid { box, sphere, capsule, hull, cylinder, cone, tapered };

taut_shape make(taut_world world, Solid kind) {
    taut_shape shape{};
    switch (kind) {
        case Solid::box:
            shape = add_box(world);
            break;
        case Solid::hull:
            shape = add_hull(world, 2);
            break;
        case Solid::sphere: {
            taut_sphere_def def;
            taut_sphere_def_init(&def);
            EXPECT_OK(taut_world_add_sphere(world, &def, &shape));
            break;
        }
        case Solid::capsule: {
            taut_capsule_def def;
            taut_capsule_def_init(&def);
            EXPECT_OK(taut_world_add_capsule(world, &def, &shape));
            break;
        }
        case Solid::cylinder: {
            taut_cylinder_def def;
            taut_cylinder_def_init(&def);
            EXPECT_OK(taut_world_add_cylinder(world, &def, &shape));
            break;
        }
        case Solid::cone: {
            taut_cone_def def;
            taut_cone_def_init(&def);
            EXPECT_OK(taut_world_add_cone(world, &def, &shape));
            break;
        }
        case Solid::tapered: {
            taut_tapered_capsule_def def;
            taut_tapered_capsule_def_init(&def);
            EXPECT_OK(taut_world_add_tapered_capsule(world, &def, &shape));
            break;
        }
    }
    return shape;
}

class DrawnSolid : public testing::TestWithParam<Solid> {};

// Corners lie on the surface of the collider, faces enclose its volume: all of it where they are flat, of 24 sides and
// 12 from pole to pole at least 0.96 of it where they are round.
TEST_P(DrawnSolid, IsItsSurface) {
    const taut_world world = make_world();
    taut_body_def def = body_def(TAUT_BODY_DYNAMIC, make(world, GetParam()), 3, -2, 7);
    def.rotation = {0.5f, -0.1f, 0.7f, 0.5f};
    def.density = 1;
    const taut_body body = add_body(world, def);
    const Picture picture = draw(world, TAUT_DRAW_SHAPES | TAUT_DRAW_FACES);
    taut_collider collider{};
    uint32_t count = 0;
    ASSERT_OK(taut_body_get_colliders(body, &collider, 1, &count));
    const auto distance = [&](const taut_pos& at) {
        taut_distance out;
        EXPECT_OK(taut_collider_closest_point(collider, at, &out));
        return std::abs(static_cast<double>(out.distance));
    };
    ASSERT_GE(picture.lines.size(), 6u);
    for (const taut_draw_line& line : picture.lines) EXPECT_LE(std::max(distance(line.from), distance(line.to)), 2e-5);
    for (const taut_draw_triangle& triangle : picture.triangles)
        for (const taut_pos& corner : triangle.corners) EXPECT_LE(distance(corner), 2e-5);
    taut_mass_properties whole;
    ASSERT_OK(taut_shape_get_mass_properties(def.shape, 1, &whole));
    const double mass = static_cast<double>(whole.mass);
    const bool flat = GetParam() == Solid::box || GetParam() == Solid::hull;
    EXPECT_LE(volume(picture.triangles), mass * 1.00001);
    EXPECT_GE(volume(picture.triangles), mass * (flat ? 0.99999 : 0.96));
    taut_world_destroy(world);
}

std::string name_of(const testing::TestParamInfo<Solid>& info) {
    constexpr const char* kNames[] = {"box", "sphere", "capsule", "hull", "cylinder", "cone", "tapered"};
    return kNames[static_cast<int>(info.param)];
}
INSTANTIATE_TEST_SUITE_P(Of, DrawnSolid,
                         testing::Values(Solid::box, Solid::sphere, Solid::capsule, Solid::hull, Solid::cylinder,
                                         Solid::cone, Solid::tapered),
                         name_of);

// A square of two triangles of one facet has no line between them; of a strip only what is near the box is drawn.
TEST(Drawing, MeshesByTheirFacetsNearTheBox) {
    const taut_world world = make_world();
    taut_shape square{}, strip{};
    ASSERT_OK(make_mesh(world, &square));
    add_body(world, body_def(TAUT_BODY_STATIC, square));
    EXPECT_EQ(draw(world, TAUT_DRAW_SHAPES).lines.size(), 4u);
    EXPECT_EQ(draw(world, TAUT_DRAW_FACES).triangles.size(), 2u);

    static float heights[2][101];
    for (int i = 0; i < 101; ++i) heights[0][i] = heights[1][i] = i % 2 ? 0.5f : 0.0f;
    taut_height_field_def def;
    taut_height_field_def_init(&def);
    def.heights = heights[0];
    def.rows = 2, def.columns = 101;
    ASSERT_OK(taut_world_add_height_field(world, &def, &strip));
    add_body(world, body_def(TAUT_BODY_STATIC, strip, 0, 50, 0));
    taut_draw_def near = def_of(TAUT_DRAW_SHAPES | TAUT_DRAW_FACES);
    near.low = {-1e3, 40, -1e3}, near.high = {1e3, 60, 1e3};
    const Picture all = draw(world, near);
    EXPECT_EQ(all.triangles.size(), 200u);
    EXPECT_EQ(all.lines.size(), 301u);  // along both sides, and across at each column
    const double middle = 0.5 * (all.triangles.front().corners[0].x + all.triangles.back().corners[0].x);
    near.low.x = middle - 0.1, near.high.x = middle + 0.1;
    const Picture part = draw(world, near);
    EXPECT_GE(part.triangles.size(), 2u);
    EXPECT_LE(part.triangles.size(), 4u);
    EXPECT_GE(part.lines.size(), 4u);
    EXPECT_LE(part.lines.size(), 8u);
    taut_world_destroy(world);
}

// A box of 4 kg at rest: four contacts whose lines of force add up to its weight, told in newtons; its mass, its axes.
TEST(Drawing, ContactsCarryTheWeight) {
    const taut_world world = make_world();
    add_body(world, body_def(TAUT_BODY_STATIC, add_plane(world)));
    taut_body_def def = body_def(TAUT_BODY_DYNAMIC, add_box(world), 0, 0.5, 0);
    def.mass = 4;
    add_body(world, def);
    for (int i = 0; i < 240; ++i) ASSERT_OK(taut_world_step(world));
    EXPECT_EQ(draw(world, TAUT_DRAW_CONTACTS).lines.size(), 4u);
    taut_draw_def forces = def_of(TAUT_DRAW_FORCES | TAUT_DRAW_LABELS);
    forces.force_scale = 0.01f;
    const Picture picture = draw(world, forces);
    ASSERT_EQ(picture.lines.size(), 4u);
    ASSERT_EQ(picture.labels.size(), 4u);
    double drawn = 0, told = 0;
    for (const taut_draw_line& line : picture.lines) drawn += length(line) / 0.01;
    for (const taut_draw_label& label : picture.labels) {
        told += std::atof(label.text);
        EXPECT_TRUE(contains(label.text, " N")) << label.text;
    }
    taut_vec3 gravity;
    ASSERT_OK(taut_world_get_gravity(world, &gravity));
    const double weight = -4 * static_cast<double>(gravity.y);
    EXPECT_NEAR(drawn, weight, 0.02 * weight);
    EXPECT_NEAR(told, weight, 0.03 * weight);
    const Picture centres = draw(world, TAUT_DRAW_CENTRES | TAUT_DRAW_LABELS);
    EXPECT_EQ(centres.lines.size(), 3u);
    ASSERT_EQ(centres.labels.size(), 1u);
    EXPECT_STREQ(centres.labels[0].text, "4 kg");
    EXPECT_EQ(draw(world, TAUT_DRAW_BOUNDS).lines.size(), 12u);
    taut_world_destroy(world);
}

// From centre to anchor, from anchor to anchor, to the other centre; a hanging weight pulls with m g.
TEST(Drawing, JointsAndWhatTheyCarry) {
    const taut_world world = make_world();
    taut_body_def def = body_def(TAUT_BODY_DYNAMIC, add_box(world), 0, -1, 0);
    def.mass = 4;
    const taut_body body = add_body(world, def);
    add_ball(world, {}, body, {0, 0, 0}, {0, 1, 0});
    for (int i = 0; i < 10; ++i) ASSERT_OK(taut_world_step(world));
    const Picture joints = draw(world, TAUT_DRAW_JOINTS);
    ASSERT_EQ(joints.lines.size(), 2u);
    EXPECT_NEAR(length(joints.lines[0]), 0, 1e-4);
    EXPECT_NEAR(length(joints.lines[1]), 1, 1e-4);
    taut_draw_def forces = def_of(TAUT_DRAW_FORCES);
    const Picture pulls = draw(world, forces);
    ASSERT_EQ(pulls.lines.size(), 1u);
    EXPECT_NEAR(length(pulls.lines[0]), 0.001 * 4 * 9.81, 0.001);
    taut_world_destroy(world);
}

// Two stacks: one colour each, and not the same; by kind both have one.
TEST(Drawing, IslandsHaveColoursOfTheirOwn) {
    const taut_world world = make_world();
    add_body(world, body_def(TAUT_BODY_STATIC, add_plane(world)));
    const taut_shape box = add_box(world);
    for (int i = 0; i < 6; ++i) add_body(world, body_def(TAUT_BODY_DYNAMIC, box, i < 3 ? 0 : 5, 0.5 + i % 3));
    for (int i = 0; i < 10; ++i) ASSERT_OK(taut_world_step(world));
    taut_draw_def def = def_of(TAUT_DRAW_SHAPES);
    def.low.y = 0.4;  // less the plane's normal, which is drawn whatever the box
    const auto colours = [&](double low, double high) {
        std::set<uint32_t> out;
        for (const taut_draw_line& line : draw(world, def).lines)
            if (line.from.y > 0.01 && line.from.x > low && line.from.x < high) out.insert(line.colour);
        return out;
    };
    EXPECT_EQ(colours(-1, 6).size(), 1u);
    def.colours = TAUT_DRAW_BY_ISLAND;
    EXPECT_EQ(colours(-1, 1).size(), 1u);
    EXPECT_EQ(colours(4, 6).size(), 1u);
    EXPECT_NE(colours(-1, 1), colours(4, 6));
    taut_world_destroy(world);
}

TEST(Drawing, FillsAsMuchAsThereIsRoomForAndTakesNoMemory) {
    Ledger ledger;
    const taut_world world = make_world(ledger.hooks());
    add_body(world, body_def(TAUT_BODY_DYNAMIC, add_box(world)));
    const Picture whole = draw(world, TAUT_DRAW_SHAPES);
    ASSERT_EQ(whole.lines.size(), 12u);
    const uint64_t calls = ledger.calls;
    std::vector<taut_draw_line> some(6, taut_draw_line{{1, 2, 3}, {}, 7, 0});
    taut_drawing drawing;
    taut_drawing_init(&drawing);
    drawing.lines = some.data(), drawing.line_capacity = 5;
    const taut_draw_def def = def_of(TAUT_DRAW_SHAPES);
    EXPECT_EQ(taut_world_draw(world, &def, &drawing), TAUT_TOO_SMALL);
    EXPECT_EQ(drawing.line_count, 12u);
    for (size_t i = 0; i < 5; ++i) EXPECT_EQ(std::memcmp(&some[i], &whole.lines[i], sizeof some[i]), 0) << i;
    EXPECT_EQ(some[5].colour, 7u);
    EXPECT_EQ(ledger.calls, calls);
    taut_world_destroy(world);
}

TEST(Drawing, RefusesWhatMakesNoSense) {
    const taut_world world = make_world();
    add_body(world, body_def(TAUT_BODY_DYNAMIC, add_box(world)));
    const taut_draw_def good = def_of(TAUT_DRAW_SHAPES);
    const auto refused = [&](const taut_draw_def* def, const taut_drawing& drawing, taut_result code, const char* why) {
        taut_drawing given = drawing;
        EXPECT_EQ(taut_world_draw(world, def, &given), code) << why;
        EXPECT_TRUE(contains(taut_last_error(), why)) << taut_last_error();
        EXPECT_EQ(std::memcmp(&given, &drawing, sizeof given), 0) << why;
    };
    taut_drawing empty;
    taut_drawing_init(&empty);
    taut_draw_def def = good;
    def.what = TAUT_DRAW_ALL + 1;
    refused(&def, empty, TAUT_INVALID_ARGUMENT, "what");
    def = good, def.force_scale = -1;
    refused(&def, empty, TAUT_INVALID_ARGUMENT, "force_scale");
    def = good, def.low.x = NAN;
    refused(&def, empty, TAUT_INVALID_ARGUMENT, "low");
    def = good, def.low.y = 1, def.high.y = 0;
    refused(&def, empty, TAUT_INVALID_ARGUMENT, "low is above high");
    def = good, def.struct_size = 3;
    refused(&def, empty, TAUT_STRUCT_SIZE, "struct_size");
    taut_drawing drawing = empty;
    drawing.label_capacity = 1;
    refused(&good, drawing, TAUT_NULL_POINTER, "labels");
    drawing = empty, drawing.reserved = 1;
    refused(&good, drawing, TAUT_INVALID_ARGUMENT, "reserved");
    EXPECT_EQ(taut_world_draw(world, &good, nullptr), TAUT_NULL_POINTER);
    taut_world_destroy(world);
    EXPECT_EQ(taut_world_draw(world, &good, &empty), TAUT_STALE_HANDLE);
}

}  // namespace
