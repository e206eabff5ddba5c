// Projected Gauss-Seidel by colour: joints and contacts in lanes, what is neither as rows.
#include "solvers/projected_gauss_seidel.h"

#include "solvers/row_sweep.h"
#include "system/assemble.h"
#include "system/colour_stages.h"
#include "system/soft_contact.h"

namespace taut {
namespace {

// What the sweeps changed becomes part of the solution, except where a direct solve owns it.
void publish(Substep& s, uint32_t begin, uint32_t end) {
    for (uint32_t i = begin; i < end; ++i) {
        const uint32_t node = s.group.nodes[i];
        if (s.system.in_block[node + 1]) continue;
        const SweepVelocity& u = s.system.velocity[node + 1];
        Velocity& exact = s.system.exact[node + 1];
        for (int k = 0; k < 3; ++k) {
            exact.v[k] += static_cast<double>(u.v[k] - static_cast<float>(exact.v[k]));
            exact.w[k] += static_cast<double>(u.w[k] - static_cast<float>(exact.w[k]));
        }
    }
}

// What the kernels work on, and one pass over a piece of it.
class Kernels {
public:
    enum class Pass : uint8_t { warm_start, first_biased, biased, relaxed, restitute };  // the first measures the gaps

    explicit Kernels(Substep& substep)
        : s_(substep),
          joints_(s_.system.joints.view()),
          contacts_(s_.system.contacts.view()),
          velocity_(s_.system.velocity.data()),
          mass_(s_.system.inverse_mass.data()),
          joint_(*s_.settings.joint_kernels),
          contact_(*s_.settings.kernels),
          soft_(contact_terms(s_.system.h)) {
        contacts_.shared = s_.team.size() > 1;
    }

    void joints(Pass pass, uint32_t begin, uint32_t end) const {
        if (pass == Pass::warm_start) joint_.warm_start(joints_, begin, end, velocity_, mass_);
        if (is_biased(pass)) joint_.sweep_biased(joints_, begin, end, velocity_, mass_, joint_terms(s_.system.h));
        if (pass == Pass::relaxed) joint_.sweep_relaxed(joints_, begin, end, velocity_, mass_);
    }
    void rows(Pass pass) const {
        const uint32_t first = s_.system.rows.joints, count = s_.system.rows.lasting - first;
        if (pass == Pass::warm_start) warm_start_rows(s_, first, count);
        if (is_biased(pass) || pass == Pass::relaxed) sweep_rows(s_, first, count, is_biased(pass));
        if (pass == Pass::restitute) bounce_rows(s_, first, count);
    }
    void contacts(Pass pass, uint32_t begin, uint32_t end) const {
        const SweepShift* const shifts = pass == Pass::first_biased ? s_.system.shift.data() : nullptr;
        if (pass == Pass::warm_start) contact_.warm_start(contacts_, begin, end, velocity_, mass_);
        if (is_biased(pass)) contact_.sweep_biased(contacts_, begin, end, velocity_, mass_, shifts, soft_);
        if (pass == Pass::relaxed) contact_.sweep_relaxed(contacts_, begin, end, velocity_, mass_, soft_);
        if (pass == Pass::restitute) contact_.restitute(contacts_, begin, end, velocity_, mass_, kBounceSpeed, s_.last);
    }

private:
    static bool is_biased(Pass pass) { return pass == Pass::biased || pass == Pass::first_biased; }

    Substep& s_;
    JointView joints_;
    LaneView contacts_;
    SweepVelocity* velocity_;
    const SweepMass* mass_;
    const JointKernels& joint_;
    const ContactKernels& contact_;
    SweepTerms soft_;
};

// Passes one after the other, as stages for the team: lane groups of a colour share no moving node, so that threads
// take them side by side; those of the overflow colour, the last, and rows go one by one. Small colours one after the
// other are a stage of one thread: another would help less than it takes to wait for it.
class Program {
public:
    using Pass = Kernels::Pass;

    explicit Program(Substep& s) : s_(s), kernels_(s) {}

    // Joints, rows, then contacts, colour by colour, backward if asked.
    void add(Pass pass, bool backward = false) {
        if (!s_.system.joints.group.empty())
            for (uint32_t c = 0; c < kMaxColours; ++c) add_joints(pass, c);
        add_rows(pass);
        add_contacts(pass, backward);
    }
    void add_restitution() {
        if (s_.system.contacts.bounces) add_contacts(Pass::restitute, false);
        if (s_.last) add_rows(Pass::restitute);
    }
    // publishes: moves what was swept to the solution after all of it.
    void run(bool publishes) {
        constexpr uint32_t kGrain = 256;  // nodes
        const auto nodes = publishes ? static_cast<uint32_t>(s_.group.nodes.size()) : 0;
        if (groups_ < kFewGroups) {
            for (uint32_t i = 0; i < count_; ++i) run(i, 0, stage_[i].count);
            return s_.team.for_ranges(nodes, kGrain, [&](uint32_t begin, uint32_t end) { publish(s_, begin, end); });
        }
        if (nodes > 0) add({What::nodes, {}, 0, nodes}, {nodes, kGrain}, false);
        s_.team.for_stages({stage_, count_}, [&](uint32_t i, uint32_t begin, uint32_t end) { run(i, begin, end); });
    }

private:
    enum class What : uint8_t { joints, rows, contacts, nodes };
    struct Piece {
        What what;
        Pass pass;
        uint32_t first, count;  // of contacts: parts of a colour
    };

    void add_joints(Pass pass, uint32_t colour) {
        const auto [first, stage] = colour_stage(s_.system.joints, colour, s_.team.size());
        if (stage.count > 0) add({What::joints, pass, first, stage.count}, stage, is_small(colour, stage.count));
        groups_ += stage.count;
    }
    void add_rows(Pass pass) {
        if (s_.system.rows.lasting > s_.system.rows.joints) add({What::rows, pass, 0, 1}, {1, 1}, true);
    }
    void add_contacts(Pass pass, bool backward) {
        if (s_.system.contacts.group.empty()) return;
        for (uint32_t k = 0; k < kMaxColours; ++k) add_colour(pass, backward ? kMaxColours - 1 - k : k);
    }
    void add_colour(Pass pass, uint32_t colour) {
        const ContactLanes& lanes = s_.system.contacts;
        const uint32_t count = lanes.size_of(colour);
        if (count > 0)
            add({What::contacts, pass, colour * lanes.parts, lanes.parts}, {lanes.parts, 1}, is_small(colour, count));
        groups_ += count;
    }
    static bool is_small(uint32_t colour, uint32_t groups) {
        constexpr uint32_t kSmall = 3;  // lane groups
        return colour + 1 == kMaxColours || groups <= kSmall;
    }
    void add(Piece piece, Team::Stage stage, bool small) {
        if (!(small && last_is_small_)) {
            stage_[count_] = small ? Team::Stage{1, 1} : stage;
            first_piece_[count_++] = pieces_;
        }
        piece_[pieces_++] = piece;
        first_piece_[count_] = pieces_;
        last_is_small_ = small;
    }

    void run(uint32_t i, uint32_t begin, uint32_t end) const {
        const Piece& first = piece_[first_piece_[i]];
        if (stage_[i].count > 1 || first.what == What::nodes) return run(first, begin, end);
        for (uint32_t k = first_piece_[i]; k < first_piece_[i + 1]; ++k) run(piece_[k], 0, piece_[k].count);
    }
    void run(const Piece& piece, uint32_t begin, uint32_t end) const {
        if (piece.what == What::joints) kernels_.joints(piece.pass, piece.first + begin, piece.first + end);
        if (piece.what == What::rows) kernels_.rows(piece.pass);
        if (piece.what == What::nodes) publish(s_, begin, end);
        for (uint32_t k = begin; piece.what == What::contacts && k < end; ++k) {
            const LanePart& part = s_.system.contacts.part[piece.first + k];
            kernels_.contacts(piece.pass, part.begin, part.end);
        }
    }

    static constexpr uint32_t kMostPasses = 3, kMost = kMostPasses * (2 * kMaxColours + 1) + 1;
    static_assert(kMost <= Team::kMaxStages);

    Substep& s_;
    Kernels kernels_;
    Piece piece_[kMost];
    Team::Stage stage_[kMost];
    uint32_t first_piece_[kMost + 1] = {};  // of each stage
    uint32_t count_ = 0, pieces_ = 0, groups_ = 0;
    bool last_is_small_ = false;
};

}  // namespace

void warm_start_sweeps(Substep& s) {
    Program program(s);
    program.add(Kernels::Pass::warm_start);
    program.run(false);
}

void sweep_biased(Substep& s) {
    const uint32_t sweeps = s.settings.sweeps ? s.settings.sweeps : s.group.sweeps;
    for (uint32_t i = 0; i < sweeps; ++i) {
        Program program(s);
        program.add(i == 0 ? Kernels::Pass::first_biased : Kernels::Pass::biased, s.corrects_backward);
        program.run(i + 1 == sweeps);
    }
}

void sweep_relaxed(Substep& s) {
    Program program(s);
    for (uint32_t i = 0; i < kRelaxSweeps; ++i) program.add(Kernels::Pass::relaxed, s.relaxes_backward);
    program.add_restitution();
    program.run(true);
}

namespace {

void solve(Substep& s) {
    warm_start_sweeps(s);
    sweep_biased(s);
}

void relax(Substep& s) { sweep_relaxed(s); }

}  // namespace

const Solver kProjectedGaussSeidel{"projected_gauss_seidel", false, true, solve, nullptr, relax};

}  // namespace taut
