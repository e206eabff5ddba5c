// A capsule among colliders: how far it goes, what it slides along and stands on, by the queries of the interface.
#pragma once

#include <taut/character.h>

#include <algorithm>
#include <array>

#include "api/access.h"
#include "movers/body_motion.h"
#include "movers/half_spaces.h"

namespace taut {

// Something at the end of a way.
struct Touch {
    taut_body body{};
    taut_collider collider{};
    Vec3 point = Vec3::Zero();
    Vec3 normal = Vec3::Zero();  // unit, out of it
};

// What it stands on or slides along.
struct Ground {
    taut_character_state state = TAUT_CHARACTER_IN_AIR;
    Touch touch;
    Vec3 normal = Vec3::Zero();  // of the surface: at an edge, of the face that it belongs to
};

// What is in its way: where it may go, and how fast, as that may move too.
struct Barriers {
    HalfSpaces ways, speeds;
};

// A call of the interface that was refused is remembered, and all later ones are left out.
class CapsuleMover {
public:
    // Of a def as checked. filter: the host's, as checked; it and what it points to outlive this.
    CapsuleMover(taut_world world, const taut_character_def& def, const taut_query_filter& filter);

    taut_result result() const { return result_; }
    // velocity: of the frame that speeds of barriers are relative to.
    void begin(const Vec3& position, const Vec3& velocity) {
        position_ = position;
        frame_velocity_ = velocity;
    }
    const Vec3& position() const { return position_; }
    const Vec3& up() const { return up_; }
    Vec3 across(const Vec3& v) const { return v - v.dot(up_) * up_; }  // the horizontal part
    // The height nearest to this that the straight part of its side has.
    double side_height(double height) const {
        const double middle = position_.dot(up_);
        return std::clamp(height, middle - half_, middle + half_);
    }
    Vec3 feet() const { return position_ - (half_ + radius_) * up_; }
    taut_pose pose_at(const Vec3& position) const;

    // Gets out of what it overlaps; how deep it still is within something [m].
    double recover();
    // Moves along a way and along what is in it. What it meets is added to touches and barriers. With stop it ends at
    // the first ground that it can stand on, which is told, with the part of the way that is left.
    void slide(const Vec3& way, Barriers& barriers, Ground* stop = nullptr, double* left = nullptr);
    // Moves along the ground by a horizontal way, over steps and slopes. Of barriers the horizontal normals count.
    void walk(const Vec3& way, Barriers& barriers);
    // What is beneath, no further than reach; where it can stand on that, it is put there.
    Ground land(double reach);
    // Bodies that the next ways do not meet.
    void ignore(taut_body body);
    void see_all() { filter_.ignored_body_count = host_bodies_; }

    BodyMotion motion_of(taut_body body);

    // Each call of the interface goes through this.
    bool ok(taut_result result) {
        if (result_ == TAUT_OK) result_ = result;
        return result_ == TAUT_OK;
    }

    static constexpr size_t kMostTouches = 16;
    const Touch* begin_touches() const { return touches_.data(); }
    const Touch* end_touches() const { return touches_.data() + touch_count_; }

private:
    bool advance(Vec3& at, const Vec3& way, Touch& touch, double& left);
    bool cast(const Vec3& from, const Vec3& way, taut_query_hit& hit);
    bool ray(const Vec3& from, const Vec3& way, taut_query_hit& hit);
    bool can_stand(const Vec3& at, const Touch& touch, Vec3& normal);
    bool drop(Vec3& at, double reach, Touch& touch, double& way);
    bool step_up(Vec3& way);
    bool is_wedged();
    void add(Barriers& barriers, const Touch& touch, const Vec3& normal);
    bool gather(double reach, HalfSpaces& all, HalfSpaces& still, double& nearest);
    void remember(const Touch& touch);

    taut_world world_;
    taut_shape shape_;
    taut_query_filter filter_;
    std::array<taut_body, TAUT_QUERY_MAX_IGNORED> bodies_{};
    std::array<taut_collider, TAUT_QUERY_MAX_IGNORED> colliders_{};
    uint32_t host_bodies_ = 0, host_colliders_ = 0;
    uint32_t passed_colliders_ = 0;  // the host's and, while it gets out of them, those that it overlaps
    taut_quat rotation_;
    Vec3 up_;
    double radius_ = 0, half_ = 0, gap_, step_height_, least_up_, steepest_;  // least_up_, steepest_: cos, tan of slope
    Vec3 position_ = Vec3::Zero(), frame_velocity_ = Vec3::Zero();
    std::array<Touch, kMostTouches> touches_;
    size_t touch_count_ = 0;
    taut_result result_ = TAUT_OK;
};

}  // namespace taut
