// Projected Gauss-Seidel by colour: joints and contacts in lanes, what is neither as rows.
#include "solvers/projected_gauss_seidel.h"

#include "constraints/soft_contact.h"
#include "solvers/row_sweep.h"
#include "system/assemble.h"
#include "system/lane_parts.h"

namespace taut {
namespace {

// What the sweeps changed becomes part of the solution, except where a direct solve_sweeps owns it.
void publish(Substep& s, uint32_t begin, uint32_t end) {
    for (uint32_t i = begin; i < end; ++i) {
        const uint32_t at = s.system.at(s.group.nodes[i]);
        if (s.system.in_block[at]) continue;
        const SweepVelocity& u = s.system.sweep[at].velocity;
        Velocity& exact = s.system.exact[at];
        for (int k = 0; k < 3; ++k) {
            exact.v[k] += static_cast<double>(u.v[k] - static_cast<float>(exact.v[k]));
            exact.w[k] += static_cast<double>(u.w[k] - static_cast<float>(exact.w[k]));
        }
    }
}

// What the kernels work on, and one pass over a piece of it.
class Kernels {
public:
    // The first of the biased ones measures the gaps of contacts, the first that corrects keeps what joints had.
    enum class Pass : uint8_t { warm_start, first_biased, biased, relaxed, first_correct, correct, take_back };

    explicit Kernels(Substep& substep)
        : s_(substep),
          joints_(s_.system.joints.view()),
          contacts_(s_.system.contacts.view()),
          nodes_(s_.system.sweep.data()),
          joint_(*s_.settings.joint_kernels),
          contact_(*s_.settings.kernels),
          elements_(s_.system.elements.view()),
          grains_(s_.system.grains.group.data()),
          surfaces_(s_.system.surfaces.view()),
          terms_{static_cast<float>(s_.system.scheme.h), static_cast<float>(1 / s_.system.scheme.act), false},
          soft_(contact_terms(s_.system.scheme.h, s_.system.stretch)) {}

    void joints(Pass pass, uint32_t begin, uint32_t end) const {
        if (pass == Pass::warm_start) joint_.warm_start(joints_, begin, end, nodes_);
        const bool relaxes = pass == Pass::relaxed && s_.system.scheme.is_one_step();  // else springs' laws do not hold
        if (is_biased(pass) || relaxes) joint_.sweep(joints_, begin, end, nodes_);
        if (pass == Pass::first_correct) joint_.keep(joints_, begin, end);
        if (pass == Pass::first_correct || pass == Pass::correct) joint_.correct(joints_, begin, end, nodes_);
        if (pass == Pass::take_back) joint_.take_back(joints_, begin, end, nodes_);
    }
    void elements(Pass pass, const ElementPass& of, uint32_t begin, uint32_t end) const {
        ElementTerms terms = terms_;
        terms.first = pass == Pass::first_biased;
        (s_.settings.element_kernels->*of.sweep)(elements_, begin, end, nodes_, s_.system.sweep_pose.data(), terms);
    }
    void grains(Pass pass, uint32_t begin, uint32_t end) const {
        const GrainKernels& grain = *s_.settings.grain_kernels;
        const SweepShift* const shifts = pass == Pass::first_biased ? s_.system.shift.data() : nullptr;
        if (pass == Pass::warm_start) grain.warm_start(grains_, begin, end, nodes_);
        if (is_biased(pass)) grain.sweep_biased(grains_, begin, end, nodes_, shifts, soft_);
        if (pass == Pass::relaxed) grain.sweep_relaxed(grains_, begin, end, nodes_, soft_);
    }
    void surfaces(Pass pass, uint32_t begin, uint32_t end) const {
        const SurfaceKernels& surface = *s_.settings.surface_kernels;
        const SweepShift* const shifts = pass == Pass::first_biased ? s_.system.shift.data() : nullptr;
        if (pass == Pass::warm_start) surface.warm_start(surfaces_, begin, end, nodes_);
        if (is_biased(pass)) surface.sweep_biased(surfaces_, begin, end, nodes_, shifts, soft_);
        if (pass == Pass::relaxed) surface.sweep_relaxed(surfaces_, begin, end, nodes_, soft_);
    }
    void rows(Pass pass) const {
        const uint32_t first = s_.system.rows.joints, count = s_.system.rows.lasting - first;
        if (pass == Pass::warm_start) warm_start_rows(s_, first, count);
        if (is_biased(pass) || pass == Pass::relaxed) sweep_rows(s_, first, count, is_biased(pass));
    }
    // shared: with nodes that other threads' groups move too.
    void contacts(Pass pass, uint32_t begin, uint32_t end, bool shared) const {
        LaneView contacts = contacts_;
        contacts.movers = shared ? s_.system.movers : 0;
        const SweepShift* const shifts = pass == Pass::first_biased ? s_.system.shift.data() : nullptr;
        if (pass == Pass::warm_start) contact_.warm_start(contacts, begin, end, nodes_);
        if (is_biased(pass)) contact_.sweep_biased(contacts, begin, end, nodes_, shifts, soft_);
        if (pass == Pass::relaxed) contact_.sweep_relaxed(contacts, begin, end, nodes_, soft_);
    }

private:
    static bool is_biased(Pass pass) { return pass == Pass::biased || pass == Pass::first_biased; }

    Substep& s_;
    JointView joints_;
    LaneView contacts_;
    SweepNode* nodes_;
    const JointKernels& joint_;
    const ContactKernels& contact_;
    ElementView elements_;
    GrainGroup* grains_;
    SurfaceView surfaces_;
    ElementTerms terms_;
    SweepTerms soft_;
};

// Passes one after the other, as stages for the team. Lane groups of a colour share no moving node, so that threads
// take a part each side by side. A thread begins a colour with the groups at the border of its part, once the others
// are through those of the colours before, and goes on with the ones inside, which only its own groups meet: while it
// is at those, the news of the border come and go. Small colours one after the other, rows and the overflow colour are
// for one thread: another would help less than it takes to wait for it.
class Program {
public:
    using Pass = Kernels::Pass;

    explicit Program(Substep& s) : s_(s), kernels_(s) { first_piece_[0] = 0; }

    // Joints, rows, then contacts between grains, of surfaces and others, colour by colour, backward if asked.
    void add_joints(Pass pass, bool backward = false) {
        if (s_.system.joints.group.empty()) return;
        const auto colours = static_cast<uint32_t>(s_.system.joints.colour_begin.size()) - 1;
        for (uint32_t k = 0; k < colours; ++k) add_joints_of(pass, backward ? colours - 1 - k : k);
    }
    // Some passes over elements, from one on.
    void add_elements(Pass pass, uint32_t begin, uint32_t end) {
        for (uint32_t k = begin; k < end; ++k) {
            const ElementPass& of = s_.system.elements.pass[k];
            groups_ += of.end - of.begin;
            if (of.overflow || of.end - of.begin <= 1)
                add_single({&Program::elements_part, pass, k});
            else
                add_alone({&Program::elements_part, pass, k});
        }
    }
    void add_rows_and_contacts(Pass pass, bool backward = false) {
        add_rows(pass);
        if (!backward) add_no_pairs(pass, false);
        add_contacts(pass, backward);
        if (backward) add_no_pairs(pass, true);
    }
    bool empty() const { return pieces_ == 0; }
    // publishes: moves what was swept to the solution after all of it.
    void run(bool publishes) {
        if (publishes) add_alone({&Program::publish_part, {}, 0});
        if (groups_ >= kFewGroups)
            return s_.team.for_parts({after_, count_}, [&](uint32_t i, uint32_t part) { run_stage(i, part); });
        for (uint32_t i = 0; i < pieces_; ++i) run_whole(piece_[i]);
    }

private:
    struct Piece;
    using PartOf = void (Program::*)(const Piece& piece, uint32_t number) const;
    struct Piece {
        PartOf part;  // one of the team's size parts
        Pass pass;
        uint32_t colour;
    };

    void add_joints_of(Pass pass, uint32_t colour) {
        const auto& begin = s_.system.joints.colour_begin;
        const uint32_t count = begin[colour + 1] - begin[colour];
        if (count == 0) return;
        groups_ += count;
        if (is_small(colour, count)) return add_single({&Program::joints_part, pass, colour});
        add_alone({&Program::joints_part, pass, colour});
    }
    void add_rows(Pass pass) {
        if (s_.system.rows.lasting > s_.system.rows.joints) add_single({&Program::rows_part, pass, 0});
    }
    // Contacts that are no pairs.
    void add_no_pairs(Pass pass, bool backward) {
        const auto grains = [&] { add_passes(s_.system.grains.pass, &Program::grains_part, pass, backward); };
        if (!backward) grains();
        add_passes(s_.system.surfaces.pass, &Program::surfaces_part, pass, backward);
        if (backward) grains();
    }
    template <class Passes>
    void add_passes(const Passes& list, PartOf part, Pass pass, bool backward) {
        const auto passes = static_cast<uint32_t>(list.size());
        for (uint32_t k = 0; k < passes; ++k) {
            const uint32_t at = backward ? passes - 1 - k : k;
            const auto& of = list[at];
            groups_ += of.end - of.begin;
            if (of.overflow || of.end - of.begin <= 1)
                add_single({part, pass, at});
            else
                add_alone({part, pass, at});
        }
    }
    void add_contacts(Pass pass, bool backward) {
        if (s_.system.contacts.group.empty()) return;
        for (uint32_t k = 0; k < kMaxColours; ++k) add_colour(pass, backward ? kMaxColours - 1 - k : k);
    }
    void add_colour(Pass pass, uint32_t colour) {
        uint32_t borders = 0, insides = 0;
        for (const LanePart& part : s_.system.contacts.parts_of(colour)) {
            borders += part.inner - part.begin;
            insides += part.end - part.inner;
        }
        if (borders + insides == 0) return;
        groups_ += borders + insides;
        if (is_small(colour, borders + insides)) return add_single({&Program::contacts_part, pass, colour});
        if (borders > 0) {
            add({&Program::borders_part, pass, colour}, through_borders_, false);
            through_borders_ = count_;
        }
        if (insides > 0) add({&Program::insides_part, pass, colour}, through_alone_, false);
    }
    static bool is_small(uint32_t colour, uint32_t groups) {
        constexpr uint32_t kSmall = 1;                               // lane groups
        return (colour + 1) % kMaxColours == 0 || groups <= kSmall;  // overflow
    }
    // After all that came before, and before all that comes.
    void add_alone(Piece piece, bool single = false) {
        add(piece, count_, single);
        through_alone_ = through_borders_ = count_;
    }
    void add_single(Piece piece) {
        if (count_ == 0 || !single_[count_ - 1]) return add_alone(piece, true);
        piece_[pieces_++] = piece;
        first_piece_[count_] = pieces_;
    }
    void add(Piece piece, uint32_t after, bool single) {
        after_[count_] = count_ > 0 ? std::max(after, after_[count_ - 1]) : 0;
        single_[count_] = single;
        piece_[pieces_++] = piece;
        first_piece_[++count_] = pieces_;
    }

    void run_stage(uint32_t i, uint32_t part) const {
        if (!single_[i]) return run(piece_[first_piece_[i]], part);
        for (uint32_t k = first_piece_[i]; part == 0 && k < first_piece_[i + 1]; ++k) run_whole(piece_[k]);
    }
    void run_whole(const Piece& piece) const {
        for (uint32_t part = 0; part < s_.team.size(); ++part) run(piece, part);
    }
    void run(const Piece& piece, uint32_t part) const { (this->*piece.part)(piece, part); }

    void joints_part(const Piece& piece, uint32_t part) const {
        const auto& begin = s_.system.joints.colour_begin;
        const uint32_t first = begin[piece.colour], count = begin[piece.colour + 1] - first;
        kernels_.joints(piece.pass, first + begin_of(part, count), first + begin_of(part + 1, count));
    }
    void elements_part(const Piece& piece, uint32_t part) const {
        const ElementPass& of = s_.system.elements.pass[piece.colour];
        const uint32_t count = of.end - of.begin;
        kernels_.elements(piece.pass, of, of.begin + begin_of(part, count), of.begin + begin_of(part + 1, count));
    }
    void grains_part(const Piece& piece, uint32_t part) const {
        const GrainPass& of = s_.system.grains.pass[piece.colour];
        const uint32_t count = of.end - of.begin;
        kernels_.grains(piece.pass, of.begin + begin_of(part, count), of.begin + begin_of(part + 1, count));
    }
    void surfaces_part(const Piece& piece, uint32_t part) const {
        const SurfacePass& of = s_.system.surfaces.pass[piece.colour];
        const uint32_t count = of.end - of.begin;
        kernels_.surfaces(piece.pass, of.begin + begin_of(part, count), of.begin + begin_of(part + 1, count));
    }
    void rows_part(const Piece& piece, uint32_t part) const {
        if (part == 0) kernels_.rows(piece.pass);
    }
    void borders_part(const Piece& piece, uint32_t part) const {
        const LanePart& lanes = lanes_of(piece, part);
        kernels_.contacts(piece.pass, lanes.begin, lanes.inner, true);
    }
    void insides_part(const Piece& piece, uint32_t part) const {
        const LanePart& lanes = lanes_of(piece, part);
        kernels_.contacts(piece.pass, lanes.inner, lanes.end, false);
    }
    void contacts_part(const Piece& piece, uint32_t part) const {
        const LanePart& lanes = lanes_of(piece, part);
        kernels_.contacts(piece.pass, lanes.begin, lanes.end, false);
    }
    void publish_part(const Piece&, uint32_t part) const {
        const auto count = static_cast<uint32_t>(s_.group.nodes.size());
        publish(s_, begin_of(part, count), begin_of(part + 1, count));
    }
    const LanePart& lanes_of(const Piece& piece, uint32_t part) const {
        return s_.system.contacts.parts_of(piece.colour)[part];
    }
    uint32_t begin_of(uint32_t part, uint32_t count) const { return begin_of_part(part, s_.team.size(), count); }

public:
    static constexpr uint32_t kMostElementPasses = 128;  // of one program

private:
    static constexpr uint32_t kMostPasses = kRelaxSweeps;
    // Colours of joints, of elements, of grains, of surfaces, and of contacts twice.
    static constexpr uint32_t kMost = kMostPasses * (6 * kMaxColours + 1) + 2 * kMaxColours + 1;
    static_assert(kMost <= Team::kMaxStages);

    Substep& s_;
    Kernels kernels_;
    Piece piece_[kMost];
    uint32_t first_piece_[kMost + 1];  // of each stage
    uint32_t after_[kMost];            // stages that all parts did before each
    bool single_[kMost];               // for one thread
    uint32_t pieces_ = 0, count_ = 0, groups_ = 0;
    uint32_t through_borders_ = 0, through_alone_ = 0;  // stages up to the last of these
};

void sweep_joints(Substep& s, Kernels::Pass pass, bool backward) {
    if (s.system.joints.group.empty()) return;
    Program program(s);
    program.add_joints(pass, backward);
    program.run(false);
}

void sweep_elements(Substep& s, Kernels::Pass pass) {
    const auto passes = static_cast<uint32_t>(s.system.elements.pass.size());
    for (uint32_t begin = 0; begin < passes; begin += Program::kMostElementPasses) {
        Program program(s);
        program.add_elements(pass, begin, std::min(passes, begin + Program::kMostElementPasses));
        program.run(false);
    }
}

}  // namespace

// Elements, whose impulses begin at 0, have their first sweep before contacts have back what they carried: a contact
// that bears what elements press on it would else throw it up first.
void warm_start_sweeps(Substep& s) {
    {
        Program program(s);
        program.add_joints(Kernels::Pass::warm_start);
        program.run(false);
    }
    sweep_elements(s, Kernels::Pass::first_biased);
    Program program(s);
    program.add_rows_and_contacts(Kernels::Pass::warm_start);
    program.run(false);
}

// Joints are swept to and fro: symmetric Gauss-Seidel, whose error shrinks without swinging on any graph. Impulses that
// sum up what sweeps leave (constraints/joint_sweep.inl) grow where it swings, as it may around loops of very unequal
// masses if all sweeps go one way: eigenvalues z of a sweep that are not real and positive give l^2 - 2 z l + z = 0,
// |l| > 1 from |z| = 1/3 on.
void sweep_biased(Substep& s) {
    using Pass = Kernels::Pass;
    const uint32_t sweeps = s.settings.sweeps ? s.settings.sweeps : s.group.sweeps;
    for (uint32_t i = 0; i < sweeps; ++i) {
        const Pass pass = i == 0 ? Pass::first_biased : Pass::biased;
        const bool last = i + 1 == sweeps;
        for (const bool backward : {false, true}) sweep_joints(s, Pass::biased, backward);
        for (uint32_t k = 0; last && k < sweeps; ++k)
            sweep_joints(s, k == 0 ? Pass::first_correct : Pass::correct, k % 2 == 1);
        if (i > 0) sweep_elements(s, pass);
        Program program(s);
        program.add_rows_and_contacts(pass, s.corrects_backward);
        program.run(last);
    }
}

void sweep_relaxed(Substep& s) {
    Program program(s);
    program.add_joints(Kernels::Pass::take_back);
    for (uint32_t i = 0; i < kRelaxSweeps; ++i) {
        program.add_joints(Kernels::Pass::relaxed, i % 2 == 1);
        program.add_rows_and_contacts(Kernels::Pass::relaxed, s.relaxes_backward);
    }
    if (!program.empty()) program.run(true);
}

namespace {

void solve_sweeps(Substep& s) {
    warm_start_sweeps(s);
    sweep_biased(s);
}

void relax_sweeps(Substep& s) { sweep_relaxed(s); }

}  // namespace

const Solver kProjectedGaussSeidel{"projected_gauss_seidel", false, true, solve_sweeps, nullptr, relax_sweeps};

}  // namespace taut
