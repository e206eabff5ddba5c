// Characters: a frame of one, in the order of its parts.
#include <taut/character.h>

#include <algorithm>
#include <cmath>

#include "api/sized.h"
#include "movers/call_parts.h"
#include "movers/capsule_mover.h"

using namespace taut;

namespace {

constexpr Range kCharacterGap{1e-4, 0.1};        // [m]
constexpr Range kCharacterStep{0, 1e3};          // [m]
constexpr Range kCharacterSlope{0, 1.55};        // [rad]
constexpr Range kCharacterAcceleration{0, 1e6};  // [m/s^2]
constexpr Range kCharacterGravity{0, 1e4};       // [m/s^2]
constexpr Range kCharacterMass{0, 1e6};          // [kg]
constexpr Range kCharacterPush{0, 1e9};          // [N]
constexpr Range kCharacterSpeed{0, 1e4};         // [m/s]
constexpr Range kCharacterSeconds{1e-4, 1};      // [s], or 0
constexpr Range kCharacterPosition{-9e6, 9e6};   // [m], so that what is about it is within reach
constexpr uint32_t kMostIgnoredBodies = TAUT_QUERY_MAX_IGNORED - 1;
constexpr uint32_t kMostIgnoredColliders = TAUT_QUERY_MAX_IGNORED - 16;

constexpr double kTakeoff = 1e-3;  // speed along up that leaves the ground [m/s]
constexpr double kUpright = 0.02;  // of a normal along up: that of a side
constexpr double kOverhead = 0.7;  // of a normal along up or down: beneath or above, not before it

// ---------------------------------------------------------------- check

bool check_character_def(Check& check, const taut_character_def& def) {
    check.within("def.")
        .number("gap", def.gap, kCharacterGap)
        .vector("up", def.up, kDirection)
        .number("gravity", def.gravity, kCharacterGravity)
        .number("step_height", def.step_height, kCharacterStep)
        .number("max_slope", def.max_slope, kCharacterSlope)
        .number("acceleration", def.acceleration, kCharacterAcceleration)
        .number("air_acceleration", def.air_acceleration, kCharacterAcceleration)
        .number("mass", def.mass, kCharacterMass)
        .number("push_force", def.push_force, kCharacterPush)
        .require(to_vec(def.up).norm() > 0, "up is 0")
        .within("");
    return static_cast<bool>(check);
}

bool check_character(Check& check, const taut_character& character) {
    check.within("character.")
        .choice("state", character.state, TAUT_CHARACTER_SLIDING)
        .bounded("position", character.position, kCharacterPosition)
        .bounded("velocity", character.velocity, kSpeed)
        .bounded("ground_velocity", character.ground_velocity, kSpeed)
        .pose("ground_pose.position", "ground_pose.rotation", character.ground_pose)
        .within("");
    return static_cast<bool>(check);
}

// ---------------------------------------------------------------- a frame

// A speed that becomes another at a constant acceleration, and the way meanwhile.
struct Ramp {
    Vec3 velocity, way;
};

Ramp ramp(const Vec3& from, const Vec3& to, double acceleration, double seconds) {
    const Vec3 change = to - from;
    const double needed = change.norm();
    const double most = acceleration * seconds;
    if (needed > most) {
        const Vec3 reached = from + most / needed * change;
        return {reached, 0.5 * seconds * (from + reached)};
    }
    const double time = acceleration > 0 ? needed / acceleration : 0.0;
    return {to, 0.5 * time * (from + to) + (seconds - time) * to};
}

class Frame {
public:
    Frame(CapsuleMover& mover, const taut_character_def& def, const taut_character& character, const Vec3& walk,
          double seconds)
        : mover_(mover),
          def_(def),
          out_(character),
          seconds_(seconds),
          walk_(mover.across(walk)),
          velocity_(to_vec(character.velocity)),
          ground_velocity_(to_vec(character.ground_velocity)) {}

    void run(double jump);
    bool publish();
    const taut_character& out() const { return out_; }

private:
    void ride();
    void step_on_ground();
    void fall();
    void come_to(const Ground& ground, bool landed);
    void clip(const Barriers& barriers);
    Vec3 moving(const Touch& touch) { return mover_.motion_of(touch.body).velocity_of(touch.point); }
    bool push(const Touch& touch, const Vec3& wanted);
    void lean(const Touch& touch);

    CapsuleMover& mover_;
    const taut_character_def& def_;
    taut_character out_;
    double seconds_;
    Vec3 walk_, velocity_, ground_velocity_;
    Ground ground_;
    bool rode_ = false;   // it has come along with the ground already
    double landing_ = 0;  // speed that it hit the ground at [m/s]
};

void Frame::run(double jump) {
    mover_.begin(to_vec(out_.position), ground_velocity_);
    ride();
    out_.overlap = to_float(mover_.recover());
    const Vec3& up = mover_.up();
    bool on_ground = out_.state == TAUT_CHARACTER_ON_GROUND;
    if (on_ground && jump > 0) velocity_ += jump * up;
    if (on_ground && velocity_.dot(up) > kTakeoff) on_ground = false;
    if (on_ground)
        step_on_ground();
    else
        fall();
}

// Along with what it stands on, as far as that has come since the last call.
void Frame::ride() {
    out_.ground_turn = 0;
    if (out_.state != TAUT_CHARACTER_ON_GROUND || !taut_body_is_valid(out_.ground_body)) return;
    taut_pose now;
    if (!mover_.ok(taut_body_get_pose(out_.ground_body, &now))) return;
    const Quat before = to_quat(out_.ground_pose.rotation), turned = to_quat(now.rotation);
    const Vec3 feet = mover_.feet();
    const Vec3 held = before.conjugate() * (feet - to_vec(out_.ground_pose.position));
    const Quat turn = turned * before.conjugate();
    // Twice the half-turn about up, in (-pi, pi].
    const double along = turn.vec().dot(mover_.up());
    const double half = turn.w() < 0 ? angle_of(-along, -turn.w()) : angle_of(along, turn.w());
    out_.ground_turn = to_float(2 * half);
    Barriers barriers;
    rode_ = true;
    mover_.ignore(out_.ground_body);
    mover_.slide(to_vec(now.position) + turned * held - feet, barriers);
    mover_.see_all();
}

void Frame::step_on_ground() {
    const Vec3 start = mover_.position();
    const Ramp speed = ramp(mover_.across(velocity_), walk_, def_.acceleration, seconds_);
    velocity_ = speed.velocity;
    Barriers barriers;
    mover_.walk(speed.way, barriers);
    clip(barriers);
    // What leans on walls goes along them no faster than its walk leads, and so comes to rest in corners.
    Vec3 led = Vec3::Zero();
    if (!barriers.ways.empty() && !barriers.speeds.nearest(walk_, led)) led.setZero();
    if (!barriers.ways.empty() && led.norm() < velocity_.norm()) velocity_ = led;
    // Down a slope of as much as it can walk on, or a step.
    const double slope = def_.max_slope;
    const double gone = mover_.across(mover_.position() - start).norm();
    const double descent = gone * slope * sinc(slope) / cosine(slope);
    come_to(mover_.land(std::max(double(def_.step_height), descent) + def_.gap), false);
}

void Frame::fall() {
    const Vec3& up = mover_.up();
    const Vec3 gravity = -double(def_.gravity) * up;
    // Where it slides it walks neither up nor against its slide.
    Vec3 wanted = walk_;
    const Vec3 down = mover_.across(to_vec(out_.ground_normal)).stableNormalized();
    if (out_.state == TAUT_CHARACTER_SLIDING)
        wanted += std::max(std::max(velocity_.dot(down), 0.0) - wanted.dot(down), 0.0) * down;
    const Ramp speed = ramp(mover_.across(velocity_), wanted, def_.air_acceleration, seconds_);
    const double rise = velocity_.dot(up);
    velocity_ = speed.velocity + rise * up + seconds_ * gravity;
    const Vec3 own = speed.way + seconds_ * rise * up + 0.5 * seconds_ * seconds_ * gravity;
    const Vec3 way = rode_ ? own : Vec3(own + seconds_ * ground_velocity_);

    Barriers barriers;
    Ground landed;
    double left = 0;
    mover_.slide(way, barriers, &landed, &left);
    clip(barriers);
    if (landed.state == TAUT_CHARACTER_ON_GROUND) {
        // The ground is where it will be at the end of the frame already.
        const Vec3 rest = left * seconds_ * mover_.across(velocity_ + ground_velocity_);
        come_to(landed, true);
        Barriers walls;
        mover_.walk(rest, walls);
        clip(walls);
        come_to(mover_.land(def_.step_height + def_.gap), false);
        return;
    }
    const Ground below = mover_.land(def_.gap);
    const bool leaves = below.state != TAUT_CHARACTER_IN_AIR &&
                        below.normal.dot(velocity_ + ground_velocity_ - moving(below.touch)) > kTakeoff;
    come_to(leaves ? Ground{} : below, true);
}

// landed: out of the air, where the ground takes over what it moved with.
void Frame::come_to(const Ground& ground, bool landed) {
    ground_ = ground;
    if (ground.state != TAUT_CHARACTER_ON_GROUND) return;
    const Vec3 now = moving(ground.touch);
    if (landed) {
        const Vec3 relative = velocity_ + ground_velocity_ - now;
        landing_ = std::max(landing_, -relative.dot(mover_.up()));
        velocity_ = mover_.across(relative);
    }
    ground_velocity_ = now;
}

// What is left of its velocity beside what is in its way, which may move.
void Frame::clip(const Barriers& barriers) {
    Vec3 left;
    if (barriers.speeds.nearest(velocity_, left))
        velocity_ = left;
    else
        velocity_.setZero();
}

// ---------------------------------------------------------------- what it gives to others

// With the force that would stop their approach within the frame, as far as it has it.
bool Frame::push(const Touch& touch, const Vec3& wanted) {
    const Vec3 flat = mover_.across(touch.normal);
    const Vec3 normal =
        touch.normal.dot(mover_.up()) > -kOverhead && flat.norm() > 0 ? flat.normalized() : touch.normal;
    const BodyMotion body = mover_.motion_of(touch.body);
    const double closing = (body.velocity_of(touch.point) - wanted).dot(normal);
    if (!body.is_pushed() || !(closing > 0)) return false;
    // A side touches along a line: it pushes where that does not tip the body.
    Vec3 point = touch.point;
    const Vec3& up = mover_.up();
    if (std::abs(touch.normal.dot(up)) < kUpright)
        point += (mover_.side_height(body.centre.dot(up)) - point.dot(up)) * up;
    const double enough = closing / (body.inv_mass_of(point, normal) * seconds_);
    const double force = std::min(enough, double(def_.push_force));
    return mover_.ok(taut_body_apply_force_at(touch.body, to_vec3(-force * normal), to_pos(point)));
}

// With its weight, and the momentum that it lands with.
void Frame::lean(const Touch& touch) {
    const BodyMotion body = mover_.motion_of(touch.body);
    if (!body.is_pushed() || !(def_.mass > 0)) return;
    const Vec3& up = mover_.up();
    const double both = body.inv_mass_of(touch.point, up) + 1 / double(def_.mass);
    const double force = double(def_.mass) * double(def_.gravity) + landing_ / (seconds_ * both);
    mover_.ok(taut_body_apply_force_at(touch.body, to_vec3(-force * up), to_pos(touch.point)));
}

bool Frame::publish() {
    const Vec3& up = mover_.up();
    out_.state = ground_.state;
    out_.position = to_pos(mover_.position());
    out_.velocity = to_vec3(velocity_);
    out_.ground_velocity = to_vec3(ground_velocity_);
    const bool carried = ground_.state != TAUT_CHARACTER_IN_AIR;
    out_.ground_normal = to_vec3(ground_.normal);
    out_.ground_point = carried ? to_pos(ground_.touch.point) : taut_pos{};
    out_.ground_body = ground_.touch.body;
    out_.ground_collider = ground_.touch.collider;
    if (!carried) out_.ground_body = {}, out_.ground_collider = {};
    out_.ground_pose = {{0, 0, 0}, {0, 0, 0, 1}, {0, 0}};
    if (carried && !mover_.ok(taut_body_get_pose(out_.ground_body, &out_.ground_pose))) return false;
    out_.pushed = 0;
    if (def_.body.bits != 0) {
        const taut_pose pose = mover_.pose_at(mover_.position());
        taut_result led = taut_body_move_kinematic(def_.body, &pose);
        if (led == TAUT_INVALID_ARGUMENT) led = taut_body_set_pose(def_.body, &pose);  // further than it could move
        if (!mover_.ok(led)) return false;
    }
    if (!(seconds_ > 0)) return true;
    // What it is led by is what it wants, not what was left of that.
    const Vec3 wanted =
        out_.state == TAUT_CHARACTER_ON_GROUND ? Vec3(walk_ + ground_velocity_) : Vec3(velocity_ + ground_velocity_);
    for (const Touch* touch = mover_.begin_touches(); touch != mover_.end_touches(); ++touch) {
        if (carried && touch->body.bits == out_.ground_body.bits) continue;
        if (touch->normal.dot(up) > kOverhead) continue;  // it is stepped on, not pushed
        out_.pushed += push(*touch, wanted) ? 1 : 0;
    }
    if (carried) lean(ground_.touch);
    return mover_.result() == TAUT_OK;
}

}  // namespace

void taut_character_def_init_sized(taut_character_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_character_def& own) {
        own = {};
        own.struct_size = sizeof own;
        own.gap = 0.01f;
        own.up = {0, 1, 0};
        own.gravity = 9.81f;
        own.step_height = 0.35f;
        own.max_slope = 0.87f;
        own.acceleration = 50;
        own.air_acceleration = 5;
        own.mass = 80;
        own.push_force = 400;
    });
}

void taut_character_init_sized(taut_character* character, uint32_t size) {
    give_defaults(character, size, [](taut_character& own) {
        own = {};
        own.struct_size = sizeof own;
        own.ground_pose.rotation = {0, 0, 0, 1};
    });
}

taut_result taut_character_move(taut_world world, const taut_character_def* given, taut_vec3 walk, float jump,
                                float seconds, taut_character* character) {
    Check check(__func__);
    return contain(check.call(), [&] {
        taut_character_def def;
        taut_character state;
        taut_query_filter filter;
        if (!take_def(check, given, taut_character_def_init, def)) return check.result();
        if (!check.pointer("character", character) ||
            !take_def(check.within("character."), character, taut_character_init, state, ""))
            return check.result();
        check.within("")
            .bounded("walk", walk, kSpeed)
            .number("jump", jump, kCharacterSpeed)
            .zero_or("seconds", seconds, kCharacterSeconds);
        if (!check_character_def(check, def) || !check_character(check, state) ||
            !take_filter(check, def.filter, kMostIgnoredBodies, kMostIgnoredColliders, filter))
            return check.result();
        if (def.body.bits != 0) {
            taut_body_kind kind = TAUT_BODY_STATIC;
            const taut_result found = taut_body_get_kind(def.body, &kind);
            if (found != TAUT_OK) return refuse_as(check, found);
            if (!check.require(kind == TAUT_BODY_KINEMATIC, "def.body is not kinematic")) return check.result();
        }
        CapsuleMover mover(world, def, filter);
        Frame frame(mover, def, state, to_vec(walk), seconds);
        frame.run(jump);
        if (mover.result() != TAUT_OK || !frame.publish()) return refuse_as(check, mover.result());
        give_def(frame.out(), character);
        return TAUT_OK;
    });
}
