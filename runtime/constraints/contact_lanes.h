// Contacts of a group in lanes: kLanes pairs of one colour side by side, so that one instruction works on many.
// No two pairs of a lane group share a moving node. Structure of arrays inside, one group after the other.
#pragma once

#include <span>
#include <utility>

#include "base/memory.h"
#include "simd/width.h"

namespace taut {

// Eight gather as an 8x8 transpose. What velocities leave of it has inverse masses, of SweepMass.
struct alignas(32) SweepVelocity {  // [m/s, rad/s]; no component is -0: what bears nothing changes no bit
    float v[3] = {0, 0, 0}, inv_mass_y = 0;
    float w[3] = {0, 0, 0}, inv_mass_z = 0;
};
struct alignas(32) SweepMass {
    float inv_mass = 0;                         // along axes that are not locked; 0: nothing moves it [1/kg]
    float inv_inertia[6] = {0, 0, 0, 0, 0, 0};  // xx, yy, zz, xy, xz, yz, world axes [1/(kg m^2)]
    float inv_mass_x = 0;  // along the world's x axis: inv_mass, or 0 where it is locked; y, z above
};
// Share of what a row would move with no axis locked, below which locks leave it nothing but rounding: k in floats, and
// a normal off the locked axis by less than a milliradian, along which a body would have to go a thousand times as far.
constexpr float kLeastFree = 0x1p-20f;

// By seat (system/system.h). A cache line each: who gathers fetches one, and threads that write to neighbours do not
// meet.
struct alignas(64) SweepNode {
    SweepVelocity velocity;
    SweepMass mass;

    void set_inv_mass(float inv_mass, float x, float y, float z) {
        mass.inv_mass = inv_mass;
        mass.inv_mass_x = x;
        velocity.inv_mass_y = y;
        velocity.inv_mass_z = z;
    }
    void set_inv_mass(float inv_mass) { set_inv_mass(inv_mass, inv_mass, inv_mass, inv_mass); }
    bool locked() const {  // some linear axis is
        return mass.inv_mass_x != mass.inv_mass || velocity.inv_mass_y != mass.inv_mass ||
               velocity.inv_mass_z != mass.inv_mass;
    }
    // Some axis is locked; as SweepSide::held().
    bool held() const {
        const auto& i = mass.inv_inertia;
        const bool turns = i[0] > 0 || i[1] > 0 || i[2] > 0, turns_about_all = i[0] > 0 && i[1] > 0 && i[2] > 0;
        return locked() || (turns && !turns_about_all);
    }
    void stop() {  // no impulse moves it
        mass = {};
        set_inv_mass(0);
    }
};
struct alignas(32) SweepShift {        // since the contacts were found
    float dx[3] = {0, 0, 0}, pad = 0;  // translation [m]
    float dq[4] = {0, 0, 0, 1};        // rotation x, y, z, w
};

struct alignas(32) SweepFlight {            // of the substep, where something may bounce
    float gained[3] = {0, 0, 0}, pad0 = 0;  // velocity that forces give the body [m/s]
    float moved[3] = {0, 0, 0}, pad1 = 0;   // by what impacts have moved where its path begins [m]
};

constexpr uint32_t kNoLanes = UINT32_MAX;

struct LanePoint;

struct alignas(64) LaneGroup {
    uint32_t a[kLanes], b[kLanes];  // index into arrays by seat
    uint32_t pair[kLanes];          // index into Pairs::list, UINT32_MAX for an empty lane
    float normal[3][kLanes], tangent[3][kLanes];
    float friction[kLanes];
    float stiffness[kLanes];          // of normal rows, in parts of what SweepTerms give
    float round[2][kLanes];           // of a and b: how far from their surfaces what turns ends [m]; is_round
    LanePoint* point;                 // one for each of `points`
    uint32_t points;                  // most points of a lane
    uint32_t first_drive = kNoLanes;  // in LaneDrive, one for each of `points`; kNoLanes: no lane has what that tells
    uint32_t bounces = 0;             // 1: some pair has restitution
    uint32_t is_round = 0;            // 1: some round is not 0
    uint32_t rolling = kNoLanes;      // in LaneRolling; kNoLanes: no lane has friction torques or an axis
    uint32_t has_axes = 0;            // 1: some lane has a shape of revolution
};

// Of a point where surfaces move, or friction has a direction or holds more where it sticks. The row of tangent 2
// counts `part` times: what has to do with it, friction masses, coupling, speed and impulse, is of that.
struct alignas(64) LaneDrive {
    float speed[2][kLanes];     // what friction drives the slip of body b on a to, of the rows of the tangents [m/s]
    float part[kLanes];         // friction along tangent 2, in parts of that along tangent 1
    float friction[2][kLanes];  // coefficients: where it slides, where it sticks
    float slid[kLanes];    // at the end of the last substep: compliance of its sliding [1/kg]; 0: it stuck; -1: it is
                           // new and sticks, as loads that are not found yet do not tell whether it slides
    float slides[kLanes];  // the same of this substep, as relaxed sweeps found it last
    float way[2][kLanes];  // friction at the start of the substep, of the rows [N s]
};

struct alignas(64) LaneRolling {   // about normal, tangent 1, tangent 2; lanes without it have zero arms
    float arm[2][kLanes];          // of spinning and of rolling [m]
    float spin_mass[kLanes];       // 1 / k about the normal [kg m^2]
    float roll_mass[3][kLanes];    // inverse of the 2x2 block about the tangents: 11, 22, 12 [kg m^2]
    float isotropic_mass[kLanes];  // 1 / its larger eigenvalue [kg m^2]
    float impulse[3][kLanes];      // [N m s]
    // Of a and b, whose points lie on circles about axes; see state/levers.h.
    float axis[2][3][kLanes];    // unit, world axes, as their levers; 0: none
    float across[2][3][kLanes];  // the unit vector across it that is nearest to the outward normal
    float rim[4][2][kLanes];     // of each point, the circle's radius [m]
};

struct alignas(64) LanePoint {           // empty places have zero masses
    float ra[3][kLanes], rb[3][kLanes];  // from the centres of mass, world axes, at detection [m]
    float gap0[kLanes];                  // separation at detection [m]
    float gap[kLanes];                   // at the start of the substep; the first biased sweep measures it
    float normal_mass[kLanes];           // 1 / k_n [kg]
    float friction_mass[3][kLanes];      // inverse of the 2x2 tangential block: 11, 22, 12 [kg]
    float isotropic_mass[kLanes];        // 1 / its larger eigenvalue [kg]
    float coupling[2][kLanes];           // slip along the tangents by a normal impulse of one [1/kg]
    float impulse[3][kLanes];            // normal, tangent 1, tangent 2 [N s]
    float peak[kLanes];                  // largest normal impulse of the frame [N s]
    float approach[kLanes];              // normal velocity before the frame's forces [m/s], negative when closing
    float restitution[kLanes];
};

// What the kernels see: plain pointers, so that no inline function is shared between builds.
struct LaneView {
    const LaneGroup* group;
    LaneDrive* drive;
    LaneRolling* rolling;
    uint32_t movers = 0;  // of groups that threads share: seats 1 to here move, and another core may hold them; else 0
};

// Points of lane groups, in pieces that stay where they are: one array would be new memory throughout whenever it
// grows, which takes the system longer to hand out than it takes to fill, and that in the frames that do the most.
class LanePoints {
public:
    explicit LanePoints(Memory& memory) : allocator_(memory), piece_(memory) {}
    ~LanePoints() {
        for (LanePoint* piece : piece_) allocator_.deallocate(piece, kPiece);
    }
    LanePoints(const LanePoints&) = delete;
    LanePoints& operator=(const LanePoints&) = delete;

    // Takes all of them back.
    void clear() {
        next_piece_ = 0;
        left_ = 0;
    }
    // Gives back what it does not need, if it is too large.
    void trim() noexcept {
        if (!is_too_large<LanePoint>(next_piece_ * kPiece, piece_.size() * kPiece)) return;
        for (; piece_.size() > with_slack(next_piece_); piece_.pop_back()) allocator_.deallocate(piece_.back(), kPiece);
    }
    // So many side by side, at most four, which hold whatever was there before. Throws std::bad_alloc.
    LanePoint* take(uint32_t count) {
        if (count > left_) begin_piece();
        left_ -= count;
        return std::exchange(next_, next_ + count);
    }

private:
    static constexpr uint32_t kPiece = 24;  // 32 KiB, of which Memory wastes little

    void begin_piece() {
        if (next_piece_ == piece_.size()) {
            reserve_more(piece_, 1);
            piece_.push_back(allocator_.allocate(kPiece));
        }
        next_ = piece_[next_piece_++];
        left_ = kPiece;
    }

    HostAllocator<LanePoint> allocator_;
    Array<LanePoint*> piece_;
    size_t next_piece_ = 0;
    LanePoint* next_ = nullptr;
    uint32_t left_ = 0;  // of the piece that next_ is in
};

// A thread's lane groups of a colour: [begin, end); those before inner share moving nodes with other threads' groups,
// of whatever colour.
struct LanePart {
    uint32_t begin = 0, inner = 0, end = 0;
    uint32_t pairs_begin = 0, pairs_end = 0;  // in ContactLanes::pairs, from those of the first lane group on
};

struct ContactLanes {
    explicit ContactLanes(Memory& memory)
        : group(memory), point(memory), drive(memory), rolling(memory), part(memory), pairs(memory), met(memory) {}

    UnsetArray<LaneGroup> group;  // of a colour, in the order of place but for borders
    LanePoints point;
    Array<LaneDrive> drive;
    Array<LaneRolling> rolling;
    uint32_t parts = 1;     // of a colour
    Array<LanePart> part;   // of each colour, by place
    Array<uint32_t> pairs;  // scratch: index into Group::pairs, of each colour by part
    Array<uint8_t> met;     // scratch, of each part by seat: 1 where it has groups

    bool bounces = false;  // some point has restitution

    // Of a point, the most that it may have.
    float most_friction(const LaneGroup& g, uint32_t k, int lane) const {
        return g.first_drive == kNoLanes ? g.friction[lane] : drive[g.first_drive + k].friction[1][lane];
    }
    // The one that it has as it slides or sticks in this substep.
    float friction_now(const LaneGroup& g, uint32_t k, int lane) const {
        if (g.first_drive == kNoLanes) return g.friction[lane];
        const LaneDrive& at = drive[g.first_drive + k];
        return at.friction[at.slid[lane] > 0 ? 0 : 1][lane];
    }
    // How much the row of a point's tangent 2 counts.
    float part_of(const LaneGroup& g, int lane) const {
        return g.first_drive == kNoLanes ? 1 : drive[g.first_drive].part[lane];
    }
    std::span<const LanePart> parts_of(uint32_t colour) const { return {&part[colour * parts], parts}; }
    // act(i), an index into part, for a thread's part of each colour in turn.
    template <class Act>
    void for_colours(uint32_t thread, Act&& act) const {
        for (uint32_t i = thread; i < part.size(); i += parts) act(i);
    }

    LaneView view() { return {group.data(), drive.data(), rolling.data(), 0}; }

    // Gives back the room of contacts that are no more, if that is most of it.
    void trim() noexcept {
        taut::trim(group);
        point.trim();
        taut::trim(drive);
        taut::trim(rolling);
        taut::trim(pairs);
    }
};

// Creep that counts as sticking: what is stopped by this part of the drop from static to kinetic friction.
constexpr float kSlips = 1.0f / 8;

// Parameters of a sweep, from the soft-contact model: frequency 0.25/h, damping ratio 10, push at most 3 m/s.
struct SweepTerms {
    float inv_h;          // [1/s]
    float bias_rate;      // [1/s], of the overlap
    float push;           // [m/s], largest push velocity
    float mass_scale;     // of the effective mass
    float impulse_scale;  // of the impulse already there
    float hit;            // [m/s], approaches that are faster are stopped without softness
};

struct ImpactTerms {
    float inv_h;      // [1/s]
    float threshold;  // [m/s], slower impacts do not bounce
};

// Of bodies a and b of a group's lanes, 1 where it turned, else 0.
struct alignas(64) LaneTurns {
    float turned[2][kLanes];
};

// The fused sweep of contacts: evaluate and solve in one pass over lanes [begin, end) of groups.
// Four builds of one source give the same bits: scalar, SSE2, AVX2, AVX-512.
struct ContactKernels {
    const char* name;
    // Effective masses and approach speeds from the geometry that assembly filled in.
    void (*prepare)(LaneView, uint32_t begin, uint32_t end, const SweepNode*);
    // Of one group within the frame: levers turn with the bodies that did, and the gaps since detection go on from the
    // new ones; then the same, but only in the lanes of such bodies, so that nothing depends on who else is in the
    // group. An impulse that fits them no more goes. Of shifts, the rotation.
    void (*turn)(LaneView, uint32_t group, const LaneTurns&, const SweepShift* shifts, const SweepNode*);
    void (*warm_start)(LaneView, uint32_t begin, uint32_t end, SweepNode*);
    // Soft normal rows and friction on the cone. shifts: gaps follow from them; null: they are as measured before.
    void (*sweep_biased)(LaneView, uint32_t begin, uint32_t end, SweepNode*, const SweepShift*, const SweepTerms&);
    // Same rows without bias or softness: removes the push from the velocity that is kept.
    void (*sweep_relaxed)(LaneView, uint32_t begin, uint32_t end, SweepNode*, const SweepTerms&);
    // Impacts of the substep: for each of four points of a group a bit for each lane whose point closes
    // faster than the threshold and gets to the surface. See solvers/restitution.h.
    void (*find_impacts)(LaneView, uint32_t begin, uint32_t end, const SweepNode*, const SweepShift*,
                         const SweepFlight*, const ImpactTerms&, uint16_t* found);
};

extern const ContactKernels kContactKernelsScalar, kContactKernelsBase, kContactKernelsAvx2, kContactKernelsAvx512;
// The widest that this machine runs.
const ContactKernels& contact_kernels();

}  // namespace taut
