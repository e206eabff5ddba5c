// Pictures of a world: what there is becomes lines, triangles and labels, in the host's arrays as far as they reach.
#include <taut/draw.h>

#include <cstdio>

#include "api/contacts.h"
#include "api/joint_kinds.h"
#include "api/sized.h"
#include "collision/outline.h"
#include "constraints/housed_anchors.h"
#include "detect/detect.h"
#include "state/joint_data.h"
#include "state/joint_reading.h"

namespace taut {
namespace {

constexpr Range kForceScale{0, 1e6};  // [m/N]
constexpr double kMark = 0.1;         // of normals and axes [m]
constexpr double kAll = 1e7;          // [m]

constexpr uint32_t kStatic = 0x9aa0a6ff, kKinematic = 0x9b6dd6ff, kDynamic = 0xf2a03dff, kAsleep = 0x3b5b92ff,
                   kSensor = 0x4caf50ff, kFrozen = 0xff2020ff, kBounds = 0x6a7078ff, kNormal = 0x20c0ffff,
                   kPush = 0xff4060ff, kJoint = 0xf0e040ff, kGap = 0xff2020ff, kWriting = 0xffffffff,
                   kAxes[3] = {0xff4040ff, 0x40ff40ff, 0x4080ffff};

template <class Record>
struct Writer {
    Record* out;
    uint32_t capacity, count = 0;

    void add(const Record& record) {
        if (count < capacity) out[count] = record;
        ++count;
    }
    bool fits() const { return count <= capacity; }
};

// A colour of its own for each number: hues by the golden ratio, at full saturation.
uint32_t colour_of(uint32_t number) {
    const uint32_t hue = number * 2654435769u, sector = hue >> 24, part = hue >> 16 & 255, rest = 255 - part;
    const uint32_t rgb[6][3] = {{255, part, 64}, {rest, 255, 64}, {64, 255, part},
                                {64, rest, 255}, {part, 64, 255}, {255, 64, rest}};
    const uint32_t* c = rgb[sector * 6 >> 8];
    return c[0] << 24 | c[1] << 16 | c[2] << 8 | 0xff;
}

class Picture {
public:
    Picture(const World& world, const taut_draw_def& def, const taut_drawing& to)
        : world_(world),
          def_(def),
          low_(to_vec(def.low)),
          high_(to_vec(def.high)),
          lines_{to.lines, to.line_capacity},
          triangles_{to.triangles, to.triangle_capacity},
          labels_{to.labels, to.label_capacity} {}

    void draw() {
        if (asks(TAUT_DRAW_SHAPES | TAUT_DRAW_FACES | TAUT_DRAW_BOUNDS)) add_colliders();
        if (asks(TAUT_DRAW_SHAPES | TAUT_DRAW_FACES)) add_softs();
        if (asks(TAUT_DRAW_CENTRES)) add_centres();
        if (asks(TAUT_DRAW_CONTACTS | TAUT_DRAW_FORCES)) add_contacts();
        if (asks(TAUT_DRAW_JOINTS | TAUT_DRAW_FORCES)) add_joints();
    }
    bool fits() const { return lines_.fits() && triangles_.fits() && labels_.fits(); }
    void count(taut_drawing& out) const {
        out.line_count = lines_.count, out.triangle_count = triangles_.count, out.label_count = labels_.count;
    }

private:
    // A shape at its place.
    struct Placed final : collision::LineSink, collision::PointSink {
        Placed(Picture& to, const collision::Placement& place, uint32_t paint)
            : picture(to), at(place), colour(paint) {}
        Vec3 world(const Vec3f& p) const { return at.position + (at.rotation * p).cast<double>(); }
        void take(const Vec3f& from, const Vec3f& to) override { picture.line(world(from), world(to), colour); }
        void take(const Vec3f& point) override {
            corner[corners++] = world(point);
            if (corners < 3) return;
            picture.triangle(corner[0], corner[1], corner[2], colour);
            corners = 0;
        }
        Picture& picture;
        const collision::Placement& at;
        uint32_t colour;
        Vec3 corner[3];
        int corners = 0;
    };

    bool asks(uint32_t bits) const { return (def_.what & bits) != 0; }
    bool sees(const Vec3& p) const { return (p.array() >= low_.array()).all() && (p.array() <= high_.array()).all(); }
    bool sees(const collision::Box& box) const {
        return (box.hi.cast<double>().array() >= low_.array()).all() &&
               (box.lo.cast<double>().array() <= high_.array()).all();
    }

    void line(const Vec3& from, const Vec3& to, uint32_t colour) { lines_.add({to_pos(from), to_pos(to), colour, 0}); }
    void triangle(const Vec3& a, const Vec3& b, const Vec3& c, uint32_t colour) {
        triangles_.add({{to_pos(a), to_pos(b), to_pos(c)}, colour, 0});
    }
    void label(const Vec3& at, double value, const char* unit) {
        taut_draw_label out{to_pos(at), kWriting, ""};
        std::snprintf(out.text, sizeof out.text, "%.3g %s", value, unit);
        labels_.add(out);
    }
    void force(const Vec3& at, const Vec3& newtons) {
        if (!asks(TAUT_DRAW_FORCES) || newtons.isZero(0)) return;
        line(at, at + static_cast<double>(def_.force_scale) * newtons, kPush);
        if (asks(TAUT_DRAW_LABELS)) label(at, newtons.norm(), "N");
    }

    uint32_t colour_of_node(uint32_t node) const {
        const NodeKind kind = world_.nodes.info[node].kind;
        if (world_.nodes.find_frozen(node)) return kFrozen;
        if (kind == NodeKind::kinematic) return kKinematic;
        if (!moves_by_forces(kind)) return kStatic;
        if (world_.nodes.rest[node] == Rest::asleep) return kAsleep;
        if (def_.colours == TAUT_DRAW_BY_ISLAND) {
            const uint32_t island = world_.partition.last_island_of(node);
            if (island != kNone) return taut::colour_of(island);
        }
        return kDynamic;
    }

    void add_colliders() {
        for (uint32_t c = 0; c < world_.colliders.record.size(); ++c) {
            const Collider& collider = world_.colliders.record[c];
            if (collider.node == kNone || world_.nodes.info[collider.node].soft != kNone) continue;
            const collision::Shape& shape = world_.shapes[collider.shape].shape;
            const collision::Placement at = placement_of(world_.nodes, collider);
            const collision::Box box = collision::bounds(shape, at);
            const bool is_plane = shape.kind == collision::ShapeKind::plane;
            if (!is_plane && !sees(box)) continue;
            Placed placed(*this, at, collider.sensor ? kSensor : colour_of_node(collider.node));
            const collision::Box near = seen_from(at);
            if (asks(TAUT_DRAW_SHAPES)) collision::outline(shape, near, placed);
            if (asks(TAUT_DRAW_FACES)) collision::triangles_of(shape, near, placed);
            if (asks(TAUT_DRAW_BOUNDS) && !is_plane) add_box(box);
        }
    }
    // The bounds, in the frame of a shape, of what is drawn of the world.
    collision::Box seen_from(const collision::Placement& at) const {
        const Vec3 middle = 0.5 * (low_ + high_) - at.position;
        const Mat3f back = at.rotation.transpose();
        const Vec3f centre = back * middle.cast<float>();
        const Vec3f half = back.cwiseAbs() * (0.5 * (high_ - low_)).cast<float>();
        return {centre - half, centre + half};
    }
    void add_box(const collision::Box& box) {
        const Vec3f middle = 0.5f * (box.lo + box.hi), half = 0.5f * (box.hi - box.lo);
        const collision::Placement at{middle.cast<double>(), Mat3f::Identity()};
        Placed placed(*this, at, kBounds);
        collision::outline({.kind = collision::ShapeKind::box, .size = half, .hull = nullptr}, {}, placed);
    }

    void add_softs() {
        for (uint32_t s = 0; s < world_.softs.record.size(); ++s) {
            if (!world_.softs.ids.live(s)) continue;
            const Soft& soft = world_.softs.record[s];
            for (uint32_t t = 0; t < soft.triangles(); ++t) {
                Vec3 x[3];
                for (uint32_t k = 0; k < 3; ++k) x[k] = world_.nodes.origin(soft.node[soft.triangle[3 * t + k]]);
                if (!sees(x[0]) && !sees(x[1]) && !sees(x[2])) continue;
                const uint32_t colour = colour_of_node(soft.node[soft.triangle[3 * t]]);
                for (uint32_t k = 0; k < 3 && asks(TAUT_DRAW_SHAPES); ++k) line(x[k], x[(k + 1) % 3], colour);
                if (asks(TAUT_DRAW_FACES)) triangle(x[0], x[1], x[2], colour);
            }
        }
    }

    void add_centres() {
        for (uint32_t node = 0; node < world_.nodes.info.size(); ++node) {
            if (world_.nodes.info[node].kind != NodeKind::dynamic) continue;
            const NodeMotion& m = world_.nodes.motion[node];
            if (!sees(m.x)) continue;
            const Mat3 R = m.q.toRotationMatrix();
            for (int k = 0; k < 3; ++k) line(m.x, m.x + kMark * R.col(k), kAxes[k]);
            if (asks(TAUT_DRAW_LABELS)) label(m.x, 1 / world_.nodes.mass[node].inv_mass, "kg");
        }
    }

    void add_contacts() {
        const double substep = static_cast<double>(told_substep(world_));
        for_contacts(world_, kNone, [&](const taut_contact& contact) {
            const Vec3 at = to_vec(contact.position), normal = to_vec(contact.normal);
            if (!sees(at)) return;
            if (asks(TAUT_DRAW_CONTACTS)) line(at, at + kMark * normal, kNormal);
            force(at, static_cast<double>(contact.normal_impulse) / substep * normal);
        });
    }

    void add_joints() {
        for (const Joint& joint : world_.joints.record) {
            if (!joint.type || joint.inner) continue;
            if (kind_of(joint).housed) {
                add_housed(joint);
                continue;
            }
            tie(joint.node[0], world_anchor(world_.nodes, joint, 0), joint.node[1],
                world_anchor(world_.nodes, joint, 1),
                [&] { return wrench_of(joint, read_joint(world_.nodes, joint)).force; });
        }
        for (uint32_t i = 0; i < world_.attachments.record.size(); ++i) {
            if (!world_.attachments.ids.live(i)) continue;
            const Attachment& of = world_.attachments.record[i];
            tie(kNone, point_of(world_.nodes, of.end[0]), kNone, point_of(world_.nodes, of.end[1]),
                [&] { return load_of(world_.nodes, world_.elements, of).force; });
        }
    }
    // From each body to where the housing guides it, and between those places.
    void add_housed(const Joint& joint) {
        const HousedAnchors anchors = read_data<HousedAnchors>(joint);
        const Pose housing = pose_of(world_.nodes, joint.node[2]);
        Vec3 end[2], guide[2];
        for (int side = 0; side < 2; ++side) {
            end[side] = world_anchor(world_.nodes, joint, side);
            guide[side] = housing.x + housing.R * anchors.guide(side);
        }
        if (!sees(end[0]) && !sees(end[1]) && !sees(guide[0]) && !sees(guide[1])) return;
        if (asks(TAUT_DRAW_JOINTS)) {
            for (int side = 0; side < 2; ++side) line(end[side], guide[side], kJoint);
            line(guide[0], guide[1], kJoint);
        }
        if (asks(TAUT_DRAW_FORCES)) force(end[1], wrench_of(joint, read_joint(world_.nodes, joint)).force);
    }
    template <class Force>
    void tie(uint32_t node_a, const Vec3& a, uint32_t node_b, const Vec3& b, Force&& newtons) {
        if (!sees(a) && !sees(b)) return;
        if (asks(TAUT_DRAW_JOINTS)) {
            if (node_a != kNone) line(world_.nodes.motion[node_a].x, a, kJoint);
            line(a, b, kGap);
            if (node_b != kNone) line(b, world_.nodes.motion[node_b].x, kJoint);
        }
        if (asks(TAUT_DRAW_FORCES)) force(a, newtons());
    }

    const World& world_;
    const taut_draw_def& def_;
    Vec3 low_, high_;
    Writer<taut_draw_line> lines_;
    Writer<taut_draw_triangle> triangles_;
    Writer<taut_draw_label> labels_;
};

bool checked(Check& check, const taut_draw_def& def) {
    check.count("what", def.what, 0, TAUT_DRAW_ALL)
        .choice("colours", def.colours, TAUT_DRAW_BY_ISLAND)
        .number("force_scale", def.force_scale, kForceScale)
        .vector("low", def.low, kPosition)
        .vector("high", def.high, kPosition)
        .require((to_vec(def.low).array() <= to_vec(def.high).array()).all(), "low is above high");
    return static_cast<bool>(check);
}

bool checked(Check& check, const taut_drawing& to) {
    const auto has = [&](const char* name, uint32_t capacity, const void* array) {
        if (capacity > 0) check.pointer(name, array);
    };
    has("lines", to.line_capacity, to.lines);
    has("triangles", to.triangle_capacity, to.triangles);
    has("labels", to.label_capacity, to.labels);
    check.zero("reserved", to.reserved);
    return static_cast<bool>(check);
}

}  // namespace
}  // namespace taut

using namespace taut;

void taut_draw_def_init_sized(taut_draw_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_draw_def& own) {
        own.struct_size = sizeof own;
        own.what = TAUT_DRAW_SHAPES | TAUT_DRAW_CONTACTS | TAUT_DRAW_JOINTS;
        own.force_scale = 0.001f;
        own.low = {-kAll, -kAll, -kAll};
        own.high = {kAll, kAll, kAll};
    });
}

void taut_drawing_init_sized(taut_drawing* drawing, uint32_t size) {
    give_defaults(drawing, size, [](taut_drawing& own) { own.struct_size = sizeof own; });
}

taut_result taut_world_draw(taut_world handle, const taut_draw_def* given, taut_drawing* out) {
    Check check(__func__);
    taut_draw_def def;
    taut_draw_def_init(&def);
    if (given && !take_def(check, given, taut_draw_def_init, def)) return check.result();
    if (!check.pointer("drawing", out)) return check.result();
    taut_drawing drawing;
    if (!take_def(check, out, taut_drawing_init, drawing, "drawing")) return check.result();
    if (!checked(check, def) || !checked(check, drawing)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        Picture picture(world, def, drawing);
        picture.draw();
        picture.count(drawing);
        give_def(drawing, out);
        if (picture.fits()) return TAUT_OK;
        return refuse(TAUT_TOO_SMALL, "%s: %u lines, %u triangles and %u labels needed", check.call(),
                      drawing.line_count, drawing.triangle_count, drawing.label_count);
    });
}
