#include "movers/capsule_mover.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

constexpr int kMostTurns = 8;        // of a way along what is in it
constexpr int kMostRecoveries = 8;   // rounds of getting out of what overlaps
constexpr double kShortest = 1e-6;   // way [m]: that of queries
constexpr double kFlat = 1e-3;       // horizontal part of the normal of a ceiling
constexpr double kLeastGain = 1e-3;  // of a way that a step opens: a wall opens what rounding gives
constexpr double kWedged = 0.05;     // sine of the slope on which nothing slides that is held from two sides
constexpr double kTiny = 1e-12;      // [1]

taut_vec3 narrow(const Vec3& v) { return to_vec3(v); }

}  // namespace

CapsuleMover::CapsuleMover(taut_world world, const taut_character_def& def, const taut_query_filter& filter)
    : world_(world),
      shape_(def.shape),
      filter_(filter),
      up_(to_vec(def.up).normalized()),
      gap_(def.gap),
      step_height_(def.step_height) {
    const double slope = def.max_slope;
    least_up_ = cosine(slope);
    steepest_ = slope * sinc(slope) / least_up_;
    rotation_ = to_quat(turn_between(Vec3::UnitY(), up_));
    host_bodies_ = filter.ignored_body_count;
    host_colliders_ = passed_colliders_ = filter.ignored_collider_count;
    std::copy_n(filter.ignored_bodies, host_bodies_, bodies_.begin());
    std::copy_n(filter.ignored_colliders, host_colliders_, colliders_.begin());
    filter_.ignored_bodies = bodies_.data();
    filter_.ignored_colliders = colliders_.data();
    if (def.body.bits != 0) bodies_[host_bodies_++] = def.body;
    see_all();
    taut_capsule_def capsule;
    taut_capsule_def_init(&capsule);
    if (!ok(taut_shape_get_capsule(shape_, &capsule))) return;
    radius_ = capsule.radius;
    half_ = capsule.half_length;
}

taut_pose CapsuleMover::pose_at(const Vec3& position) const { return {to_pos(position), rotation_, {0, 0}}; }

void CapsuleMover::ignore(taut_body body) {
    if (body.bits == 0 || filter_.ignored_body_count == TAUT_QUERY_MAX_IGNORED) return;
    bodies_[filter_.ignored_body_count++] = body;
}

void CapsuleMover::remember(const Touch& touch) {
    const auto end = touches_.begin() + static_cast<ptrdiff_t>(touch_count_);
    const bool known =
        std::any_of(touches_.begin(), end, [&](const Touch& each) { return each.body.bits == touch.body.bits; });
    if (!known && touch_count_ < kMostTouches) touches_[touch_count_++] = touch;
}

// ---------------------------------------------------------------- bodies

BodyMotion CapsuleMover::motion_of(taut_body body) {
    BodyMotion motion;
    ok(read_motion(body, motion));
    return motion;
}

// ---------------------------------------------------------------- ways

bool CapsuleMover::cast(const Vec3& from, const Vec3& way, taut_query_hit& hit) {
    if (result_ != TAUT_OK || way.norm() < 2 * kShortest) return false;
    const taut_shape_cast cast = {shape_, pose_at(from), narrow(way), 0};
    filter_.ignored_collider_count = passed_colliders_;
    // What it overlaps at the start and leaves is not in its way.
    while (ok(taut_world_cast_shape(world_, &cast, &filter_, &hit)) && hit.body.bits != 0) {
        if (!hit.inside || to_vec(hit.normal).dot(way) < 0 || filter_.ignored_collider_count == TAUT_QUERY_MAX_IGNORED)
            return true;
        colliders_[filter_.ignored_collider_count++] = hit.collider;
    }
    return false;
}

bool CapsuleMover::ray(const Vec3& from, const Vec3& way, taut_query_hit& hit) {
    if (result_ != TAUT_OK || way.norm() < 2 * kShortest) return false;
    const taut_ray ray = {to_pos(from), narrow(way), 0};
    filter_.ignored_collider_count = host_colliders_;
    return ok(taut_world_cast_ray(world_, &ray, &filter_, &hit)) && hit.body.bits != 0;
}

// Goes as far as the gap to what is met allows; true: it met something, and part of the way is left. A plane that is
// met at an angle of which the sine is a is as near as the gap by gap / a before.
bool CapsuleMover::advance(Vec3& at, const Vec3& way, Touch& touch, double& left) {
    left = 0;
    const double length = way.norm();
    if (length < kShortest) return false;
    const Vec3 direction = way / length;
    const double search = length + 2 * gap_;
    taut_query_hit hit;
    if (!cast(at, search * direction, hit)) {
        if (result_ == TAUT_OK) at += way;
        return false;
    }
    touch = {hit.body, hit.collider, to_vec(hit.point), to_vec(hit.normal)};
    const double approach = std::max(-touch.normal.dot(direction), kTiny);
    const double free = std::max(double(hit.fraction) * search - gap_ / approach, 0.0);
    if (free >= length) {
        at += way;
        return false;
    }
    at += free * direction;
    left = (length - free) / length;
    return true;
}

// What comes nearer moves it by recover() alone and leaves it its velocity; what draws back lets it follow.
void CapsuleMover::add(Barriers& barriers, const Touch& touch, const Vec3& normal) {
    barriers.ways.add(normal);
    const Vec3 motion = motion_of(touch.body).velocity_of(touch.point) - frame_velocity_;
    barriers.speeds.add(normal, std::min(normal.dot(motion), 0.0));
}

void CapsuleMover::slide(const Vec3& way, Barriers& barriers, Ground* stop, double* left) {
    Vec3 rest = way;
    double share = 1;
    if (!barriers.ways.nearest(way, rest)) rest.setZero();
    for (int turn = 0; turn < kMostTurns; ++turn) {
        Touch touch;
        double part = 0;
        if (!advance(position_, rest, touch, part)) return;
        remember(touch);
        share *= part;
        Vec3 normal;
        if (stop && touch.normal.dot(up_) > 0 && can_stand(position_, touch, normal)) {
            *stop = {TAUT_CHARACTER_ON_GROUND, touch, normal};
            *left = share;
            return;
        }
        add(barriers, touch, touch.normal);
        const Vec3 before = part * rest;
        if (!barriers.ways.nearest(before, rest)) return;
    }
}

// Slopes lift it, so that its horizontal way is what was asked for; what is steeper stops it as a wall does.
void CapsuleMover::walk(const Vec3& way, Barriers& barriers) {
    Vec3 rest = way;
    double lift = 0;  // in parts of the way, of the steepest slope met in this direction
    std::array<Vec3, HalfSpaces::kMost> slope;
    size_t slope_count = 0;
    for (int turn = 0; turn < 2 * kMostTurns; ++turn) {
        lift = 0;
        for (size_t i = 0; i < slope_count; ++i) lift = std::max(lift, -slope[i].dot(rest) / slope[i].dot(up_));
        Touch touch;
        double part = 0;
        if (!advance(position_, rest + lift * up_, touch, part)) return;
        remember(touch);
        rest *= part;
        const double upward = touch.normal.dot(up_);
        if (upward >= least_up_) {
            if (slope_count == slope.size()) return;
            slope[slope_count++] = touch.normal;
            continue;
        }
        if (upward > -kFlat && step_up(rest)) continue;
        const Vec3 flat = across(touch.normal);
        if (flat.norm() < kFlat) return;
        add(barriers, touch, flat.normalized());
        const Vec3 before = rest;
        if (!barriers.ways.nearest(before, rest)) return;
    }
}

// Up, on and down again, onto what it can stand on.
bool CapsuleMover::step_up(Vec3& way) {
    if (way.norm() < 10 * kShortest || step_height_ <= gap_) return false;
    Touch touch;
    double left = 0;
    Vec3 at = position_;
    advance(at, step_height_ * up_, touch, left);
    const double risen = (at - position_).dot(up_);
    if (risen <= 0) return false;
    const Vec3 above = at;
    const bool stopped = advance(at, way, touch, left);
    const double gone = (at - above).norm();
    if (gone < kShortest + kLeastGain * way.norm()) return false;
    double down = 0;
    Vec3 normal;
    const double floor = (feet() - gap_ * up_).dot(up_);
    if (!drop(at, risen + gap_, touch, down) || touch.point.dot(up_) > floor + step_height_) return false;
    if (!can_stand(at, touch, normal)) return false;
    position_ = at;
    way *= stopped ? left : 0.0;
    return true;
}

// ---------------------------------------------------------------- ground

// Down to what is beneath, down to the gap to it: as of a ball of the capsule's radius over a point, which is that of
// an edge and hardly less than of a plane.
bool CapsuleMover::drop(Vec3& at, double reach, Touch& touch, double& way) {
    const double search = reach + 2 * gap_;
    taut_query_hit hit;
    if (!cast(at, -search * up_, hit)) return false;
    touch = {hit.body, hit.collider, to_vec(hit.point), to_vec(hit.normal)};
    const double height = radius_ * std::max(touch.normal.dot(up_), 0.0);
    const double back = std::sqrt(height * height + gap_ * (2 * radius_ + gap_)) - height;
    way = double(hit.fraction) * search - back;
    if (way > reach) return false;
    at -= std::max(way, -gap_) * up_;
    return true;
}

// On what is not too steep; and on an edge of such a face, which meets a ball from any side, if there is ground within
// a step beneath the middle: on the edge of a step, not on that of a cliff.
bool CapsuleMover::can_stand(const Vec3& at, const Touch& touch, Vec3& normal) {
    const double upward = touch.normal.dot(up_);
    normal = touch.normal;
    if (upward >= least_up_) return true;
    const Vec3 flat = across(touch.normal);
    if (upward <= 0 || flat.norm() < kFlat) return false;
    const double rise = gap_ * (steepest_ + 0.1);
    taut_query_hit hit;
    if (!ray(touch.point - gap_ * flat.normalized() + rise * up_, -2 * rise * up_, hit) || hit.inside) return false;
    if (to_vec(hit.normal).dot(up_) < least_up_) return false;
    normal = to_vec(hit.normal);
    if (!ray(at - half_ * up_, -(radius_ + step_height_ + 2 * gap_) * up_, hit)) return false;
    const double height = (touch.point - to_vec(hit.point)).dot(up_);
    return height <= step_height_ && to_vec(hit.normal).dot(up_) >= least_up_;
}

Ground CapsuleMover::land(double reach) {
    Ground ground;
    Vec3 at = position_;
    double way = 0;
    if (!drop(at, reach, ground.touch, way)) return ground;
    if (can_stand(at, ground.touch, ground.normal)) {
        ground.state = TAUT_CHARACTER_ON_GROUND;
        position_ = at;
    } else if (way <= gap_ && ground.touch.normal.dot(up_) > 0) {
        ground.state = is_wedged() ? TAUT_CHARACTER_ON_GROUND : TAUT_CHARACTER_SLIDING;
        if (ground.state == TAUT_CHARACTER_ON_GROUND) ground.normal = up_;
    }
    return ground;
}

// Whether what is too steep to stand on holds it from several sides.
bool CapsuleMover::is_wedged() {
    const Vec3 here = position_;
    const size_t touches = touch_count_;
    Barriers barriers;
    slide(-4 * gap_ * up_, barriers);
    position_ = here;
    touch_count_ = touches;
    Vec3 down;
    return barriers.ways.size() > 1 && (!barriers.ways.nearest(-up_, down) || down.norm() < kWedged);
}

// ---------------------------------------------------------------- overlap

// The planes by which all that is near would be out of the gap, and those of what is static; false: nothing is nearer
// than half of it.
bool CapsuleMover::gather(double reach, HalfSpaces& all, HalfSpaces& still, double& nearest) {
    const taut_pose pose = pose_at(position_);
    filter_.ignored_collider_count = passed_colliders_ = host_colliders_;
    nearest = gap_;
    for (size_t i = 0; i < HalfSpaces::kMost; ++i) {
        taut_distance distance;
        if (!ok(taut_world_nearest_collider(world_, shape_, &pose, static_cast<float>(reach), &filter_, &distance)) ||
            distance.body.bits == 0)
            break;
        if (i == 0) {
            nearest = distance.distance;
            if (nearest > 0.5 * gap_) return false;
            reach = 2 * gap_ + std::max(-nearest, 0.0);
        }
        const Vec3 normal = -to_vec(distance.normal);
        const double missing = gap_ - double(distance.distance);
        all.add(normal, missing);
        taut_body_kind kind = TAUT_BODY_STATIC;
        ok(taut_body_get_kind(distance.body, &kind));
        if (kind == TAUT_BODY_STATIC) still.add(normal, missing);
        if (missing > 0) remember({distance.body, distance.collider, to_vec(distance.on_b), normal});
        if (filter_.ignored_collider_count == TAUT_QUERY_MAX_IGNORED) break;
        colliders_[filter_.ignored_collider_count++] = distance.collider;
        if (distance.distance < 0) ++passed_colliders_;  // they come first
    }
    return result_ == TAUT_OK && !all.empty();
}

// The least way out of all of it; where there is none, out of what is static. Through what it does not overlap it is
// not pushed.
double CapsuleMover::recover() {
    double nearest = gap_;
    for (int round = 0; round < kMostRecoveries; ++round) {
        HalfSpaces all, still;
        if (!gather(gap_, all, still, nearest)) break;
        Vec3 out;
        if (!all.nearest(Vec3::Zero(), out) && (still.empty() || !still.nearest(Vec3::Zero(), out)))
            out = all.compromise();
        Touch touch;
        double left = 0;
        const Vec3 before = position_;
        advance(position_, out, touch, left);
        passed_colliders_ = host_colliders_;
        if ((position_ - before).norm() < kShortest) break;
    }
    return std::max(-nearest, 0.0);
}

}  // namespace taut
