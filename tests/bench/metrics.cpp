#include "metrics.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "overlap.h"
#include "vector.h"

namespace bench {

namespace {

constexpr double kFallBelow = -0.5;     // a centre this far below the ground has escaped [m]
constexpr double kStandingDrop = 0.25;  // a top body that sank or moved further no longer stands [m]
constexpr double kBlownGap = 0.25;      // of a link
constexpr double kBlownEnergy = 0.02;   // rise over the start
constexpr double kLeastFall = 0.01;     // of m g L: a start with less hangs already

bool is_finite(const Motion& m) {
    for (double v : {m.position.x, m.position.y, m.position.z})
        if (!std::isfinite(v)) return false;
    for (float v : {m.rotation.x, m.rotation.y, m.rotation.z, m.rotation.w, m.linear_velocity.x, m.linear_velocity.y,
                    m.linear_velocity.z, m.angular_velocity.x, m.angular_velocity.y, m.angular_velocity.z})
        if (!std::isfinite(v)) return false;
    return true;
}

double kinetic_energy(const Motion& m, const Mass& mass) {
    Vec v = of(m.linear_velocity), w = rotate_back(m.rotation, of(m.angular_velocity));
    const taut_sym3& i = mass.inertia;
    Vec spin = {static_cast<double>(i.xx) * w.x + static_cast<double>(i.xy) * w.y + static_cast<double>(i.xz) * w.z,
                static_cast<double>(i.xy) * w.x + static_cast<double>(i.yy) * w.y + static_cast<double>(i.yz) * w.z,
                static_cast<double>(i.xz) * w.x + static_cast<double>(i.yz) * w.y + static_cast<double>(i.zz) * w.z};
    return 0.5 * mass.mass * dot(v, v) + 0.5 * dot(w, spin);
}

Vec place(const std::vector<Motion>& motions, int body, taut_pos anchor) {
    if (body == scenes::kWorld) return of(anchor);
    const Motion& m = motions[static_cast<size_t>(body)];
    return of(m.position) + rotate(m.rotation, of(anchor));
}

uint32_t window(const scenes::Scene& scene, uint32_t steps, double seconds) {
    auto count = static_cast<uint32_t>(std::lround(seconds / static_cast<double>(scene.world.time_step)));
    return steps > count ? steps - count : 0;
}

bool is_surface(const scenes::Shape& shape) {
    return shape.kind == scenes::ShapeKind::mesh || shape.kind == scenes::ShapeKind::height_field;
}

// A scene's shapes with scaled hulls told by their points.
std::vector<scenes::Shape> unscaled(std::vector<scenes::Shape> shapes) {
    for (scenes::Shape& shape : shapes) {
        if (shape.kind != scenes::ShapeKind::scaled_hull) continue;
        shape.kind = scenes::ShapeKind::hull;
        shape.points = shapes[static_cast<size_t>(shape.hull)].points;
        for (taut_vec3& p : shape.points) p = {p.x * shape.scale.x, p.y * shape.scale.y, p.z * shape.scale.z};
    }
    return shapes;
}

}  // namespace

const char* const kFieldHelp = R"(JSON fields (one object on one line):
  engine scene threads bodies steps runs
                                      what ran; bodies counts dynamic bodies and particles
  made_ms                             what the calling thread worked to make the world
  bytes_max                           memory that it held, the most after any step
  mean_ms median_ms p99_ms max_ms     wall time of one step, the quietest of the runs
  thread_mean_ms thread_median_ms thread_max_ms
                                      what the calling thread worked of it: on one thread, without what else ran
  late_ms                             wall time, median of the last 60 steps
  worst_step worst_ratio worst_stage  the slowest, in parts of the median, and what made it slow; by the time that
                                      the calling thread worked
  beside beside_mean_ms beside_median_ms mean_ratio median_ratio
                                      with --beside: what the other took, and which part of it this did
  finite                              1 if every pose and velocity stayed finite
  state_hash                          of the final state; equal hashes mean equal runs
 piles: from final poses and true shapes
  pen_mean_mm pen_max_mm              overlap of the pairs that overlap; meshes and height fields are left out
  rest_speed                          mean speed over the last second [m/s]
  escaped                             bodies outside the bin, below the ground or not finite
  overlap_mean_pct overlap_max_pct fallen
                                      of grains: pen_mean_mm and pen_max_mm in % of a radius, and escaped
 stacks: the top body against its start
  drop_mm drop_pct lateral_mm         sinking, the same in % of its height, sideways drift
  standing                            1 if it sank and drifted by less than 250 mm
 chains and cables
  joint_sep_pct                       largest joint gap (rod: length error) of the last 5 s, % of a link
  stretch_pct                         largest change of the whole chain's length in the last 5 s, %
  energy_max energy_end               largest and last total energy as (E - E_ref) / (E_start - E_ref), where E_ref
                                      is everything hanging straight down at rest: 1 is conservation. A chain that
                                      hangs at the start: 1 + (E - E_start) / (m g L) of its weight
  blew_up                             1 if not finite, energy_max > 1.02, or a gap was above 25 % of a link
  first_vertical_s                    when the weight first passes below the anchor (null: never)
  period_s                            of a swing, mean over the run
 cloths and solids: by their vertices alone
  vertices elements                   of all of them; triangles, tetrahedra and hexahedra
  peak_pct end_pct mean_pct           stretch of warp and weft edges: worst ever, worst at the end, mean at the end
  energy_lost_m                       kinetic energy and that of height lost after a second, over m g of all that moves
  energy_max                          largest such energy: 1 + (E - E_start) / (m g L), L the longest side at rest
  deep_mm deep_end_mm                 deepest point inside a rigid shape, ever and at the end: vertices, middles of edges,
                                      centres of faces; meshes and height fields are left out
  pairs pairs_end                     triangles that cross and share no vertex, of a cloth's own and of different ones,
                                      most of the samples (each tenth step) and at the end
  inverted inverted_end               cells turned inside out, most ever and at the end
  inverted_until                      steps after which none was any more
  pairs_own pairs_own_end             crossing triangles of a solid's own boundary
  tip_ratio                           of a beam: mean sink of its end over the last second, in parts of theory's
  rest_speed                          mean speed of vertices over the last second [m/s]
 nets: joint_sep_pct                  largest joint gap of the whole run, % of a mesh
 solved directly
  solve_us                            mean of one substep's assembly and direct solve
 as run: solver substeps seed geometric_stiffness adaptive_damping
 with --sleep: asleep                 bodies at the end)";

Metrics::Metrics(const scenes::Scene& scene, const Engine& engine, uint32_t steps)
    : scene_(scene),
      engine_(engine),
      last_second_(window(scene, steps, 1)),
      last_five_seconds_(window(scene, steps, 5)),
      motions_(scene.bodies.size()),
      masses_(scene.bodies.size()),
      hang_height_(scene.bodies.size()) {
    for (size_t i = 0; i < scene.bodies.size(); ++i) {
        masses_[i] = engine.mass(i);
        hang_height_[i] = scene.bodies[i].position.y;
    }
    read_motions();
    start_ = motions_;
    if (!scene.cloths.empty() || !scene.solids.empty())
        soft_.emplace(scene, engine, steps, energy_above_hanging(), moving_mass());
    if (!scene.roles.chain) return;
    const scenes::Chain& chain = *scene.roles.chain;
    for (size_t i = 0; i < chain.bodies.size(); ++i)
        hang_height_[static_cast<size_t>(chain.bodies[i])] = chain.anchor.y - chain.hang_depth[i];
    energy_start_ = energy_most_ = energy_last_ = energy_above_hanging();
    double fall = masses_[static_cast<size_t>(chain.bodies.back())].mass * -static_cast<double>(scene.world.gravity.y) *
                  chain.length;
    energy_unit_ = energy_start_ > kLeastFall * fall ? energy_start_ : fall;
    side_ = motions_[static_cast<size_t>(chain.bodies.back())].position.x - chain.anchor.x;
}

void Metrics::read_motions() {
    for (size_t i = 0; i < motions_.size(); ++i) {
        motions_[i] = engine_.motion(i);
        finite_ = finite_ && is_finite(motions_[i]);
    }
}

// Total energy over the state in which the chain hangs straight down and all else is where it began [J].
double Metrics::energy_above_hanging() const {
    double sum = 0, gravity = -static_cast<double>(scene_.world.gravity.y);
    for (size_t i = 0; i < motions_.size(); ++i)
        if (masses_[i].mass > 0)
            sum += kinetic_energy(motions_[i], masses_[i]) +
                   masses_[i].mass * gravity * (motions_[i].position.y - hang_height_[i]);
    return sum;
}

double Metrics::moving_mass() const {
    double sum = 0;
    for (const Mass& mass : masses_) sum += mass.mass;
    return sum;
}

double Metrics::joint_gap(const scenes::Joint& joint) const {
    double distance =
        length(place(motions_, joint.body_b, joint.anchor_b) - place(motions_, joint.body_a, joint.anchor_a));
    return joint.kind == TAUT_JOINT_DISTANCE ? std::fabs(distance - static_cast<double>(joint.length)) : distance;
}

void Metrics::follow_chain(uint32_t step) {
    const scenes::Chain& chain = *scene_.roles.chain;
    energy_last_ = energy_above_hanging();
    energy_most_ = std::max(energy_most_, energy_last_);
    // The chain's length is that of its links and of the gaps between them.
    double gap = 0, growth = 0, total = 0;
    for (int index : chain.joints) {
        const scenes::Joint& joint = scene_.joints[static_cast<size_t>(index)];
        double distance =
            length(place(motions_, joint.body_b, joint.anchor_b) - place(motions_, joint.body_a, joint.anchor_a));
        gap = std::max(gap, joint_gap(joint));
        growth += distance - static_cast<double>(joint.length);
        total += chain.link_length;
    }
    gap_most_ = std::max(gap_most_, gap);
    stretch_most_ = std::max(stretch_most_, std::fabs(growth) / total);
    if (step >= last_five_seconds_) {
        gap_late_ = std::max(gap_late_, gap);
        stretch_late_ = std::max(stretch_late_, std::fabs(growth) / total);
    }
    double side = motions_[static_cast<size_t>(chain.bodies.back())].position.x - chain.anchor.x;
    if (side * side_ < 0 || (side == 0 && side_ != 0))
        crossings_.push_back((step + side_ / (side_ - side)) * static_cast<double>(scene_.world.time_step));
    side_ = side;
}

void Metrics::follow_net() {
    for (const scenes::Joint& joint : scene_.joints) net_gap_ = std::max(net_gap_, joint_gap(joint));
}

void Metrics::after_step(uint32_t step) {
    read_motions();
    finite_ = finite_ && engine_.quarantined() == 0;
    if (step >= last_second_)
        for (int body : scene_.roles.pile) {
            rest_sum_ += length(of(motions_[static_cast<size_t>(body)].linear_velocity));
            ++rest_count_;
        }
    if (scene_.roles.chain) follow_chain(step);
    if (scene_.roles.mesh_width > 0) follow_net();
    if (soft_) soft_->after_step(step, energy_above_hanging(), motions_);
}

Metrics::Overlaps Metrics::overlaps() const {
    std::set<std::pair<int, int>> joined;
    for (const scenes::Joint& joint : scene_.joints) joined.insert(std::minmax(joint.body_a, joint.body_b));
    std::vector<bool> in_pile(scene_.bodies.size(), false);
    for (int body : scene_.roles.pile) in_pile[static_cast<size_t>(body)] = true;
    const std::vector<scenes::Shape> shapes = unscaled(scene_.shapes);
    auto shape_of = [&](size_t i) { return &shapes[static_cast<size_t>(scene_.bodies[i].shape)]; };
    // Sweep along x: those that reach as far as a body begins.
    struct Reach {
        double low, high;
        size_t body;
    };
    std::vector<Reach> order;
    for (size_t i = 0; i < scene_.bodies.size(); ++i) {
        if (scene_.bodies[i].shape < 0 || is_surface(*shape_of(i))) continue;
        const double x = motions_[i].position.x, radius = bounding_radius(*shape_of(i));
        order.push_back({x - radius, x + radius, i});
    }
    std::sort(order.begin(), order.end(),
              [](const Reach& a, const Reach& b) { return std::pair(a.low, a.body) < std::pair(b.low, b.body); });
    Overlaps result;
    size_t count = 0;
    for (auto first = order.begin(); first != order.end(); ++first)
        for (auto second = first + 1; second != order.end() && second->low <= first->high; ++second) {
            const auto [i, k] = std::minmax(first->body, second->body);
            const scenes::Body &a = scene_.bodies[i], &b = scene_.bodies[k];
            if ((!in_pile[i] && !in_pile[k]) || (a.group < 0 && a.group == b.group)) continue;
            if (joined.contains({static_cast<int>(i), static_cast<int>(k)})) continue;
            double near = bounding_radius(*shape_of(i)) + bounding_radius(*shape_of(k));
            if (length(of(motions_[k].position) - of(motions_[i].position)) > near) continue;
            double depth = overlap_depth({shape_of(i), motions_[i].position, motions_[i].rotation},
                                         {shape_of(k), motions_[k].position, motions_[k].rotation});
            if (!(depth > 0)) continue;
            result.mean += depth;
            result.max = std::max(result.max, depth);
            ++count;
        }
    if (count > 0) result.mean /= static_cast<double>(count);
    return result;
}

uint32_t Metrics::escaped() const {
    uint32_t count = 0;
    for (int body : scene_.roles.pile) {
        const Motion& m = motions_[static_cast<size_t>(body)];
        bool out = !is_finite(m) || m.position.y < kFallBelow;
        if (const auto& bin = scene_.roles.bin)
            out = out || m.position.x < bin->low.x || m.position.x > bin->high.x || m.position.z < bin->low.z ||
                  m.position.z > bin->high.z || m.position.y > bin->high.y;
        count += out;
    }
    return count;
}

void Metrics::report_pile(nlohmann::ordered_json& json) const {
    Overlaps found = overlaps();
    json["pen_mean_mm"] = 1e3 * found.mean;
    json["pen_max_mm"] = 1e3 * found.max;
    json["rest_speed"] = rest_count_ > 0 ? rest_sum_ / static_cast<double>(rest_count_) : 0.0;
    json["escaped"] = escaped();
    const double radius = grain_radius();
    if (!(radius > 0)) return;
    json["overlap_mean_pct"] = 100 * found.mean / radius;
    json["overlap_max_pct"] = 100 * found.max / radius;
    json["fallen"] = escaped();
}

// Of a pile of particles alone, which have one shape; else 0 [m].
double Metrics::grain_radius() const {
    const auto body = [&](int index) -> const scenes::Body& { return scene_.bodies[static_cast<size_t>(index)]; };
    const std::vector<int>& pile = scene_.roles.pile;
    const bool grains = std::all_of(pile.begin(), pile.end(), [&](int i) {
        return body(i).kind == TAUT_BODY_PARTICLE && body(i).shape == body(pile.front()).shape;
    });
    return grains ? static_cast<double>(scene_.shapes[static_cast<size_t>(body(pile.front()).shape)].radius) : 0;
}

void Metrics::report_stack(nlohmann::ordered_json& json) const {
    auto top = static_cast<size_t>(scene_.roles.top_body);
    Vec moved = of(motions_[top].position) - of(start_[top].position);
    double lateral = std::hypot(moved.x, moved.z);
    json["drop_mm"] = -1e3 * moved.y;
    json["drop_pct"] = -100 * moved.y / start_[top].position.y;
    json["lateral_mm"] = 1e3 * lateral;
    json["standing"] = std::fabs(moved.y) < kStandingDrop && lateral < kStandingDrop ? 1 : 0;
}

ChainFigures Metrics::chain() const {
    const double link = scene_.roles.chain->link_length;
    ChainFigures f;
    f.gap_most = gap_most_ / link;
    f.gap_late = gap_late_ / link;
    f.stretch_most = stretch_most_;
    f.stretch_late = stretch_late_;
    f.energy = 1 + (energy_last_ - energy_start_) / energy_unit_;
    f.energy_most = 1 + (energy_most_ - energy_start_) / energy_unit_;
    f.blew_up = !finite_ || !(f.energy_most <= 1 + kBlownEnergy) || !(f.gap_most <= kBlownGap);
    return f;
}

void Metrics::report_chain(nlohmann::ordered_json& json) const {
    const ChainFigures f = chain();
    json["joint_sep_pct"] = 100 * f.gap_late;
    json["stretch_pct"] = 100 * f.stretch_late;
    json["blew_up"] = f.blew_up ? 1 : 0;
    json["energy_max"] = f.energy_most;
    json["energy_end"] = f.energy;
    json["first_vertical_s"] = nullptr;
    if (!crossings_.empty()) json["first_vertical_s"] = crossings_.front();
    if (scene_.roles.swings && crossings_.size() > 1)
        json["period_s"] = 2 * (crossings_.back() - crossings_.front()) / static_cast<double>(crossings_.size() - 1);
}

void Metrics::report(nlohmann::ordered_json& json) const {
    if (!scene_.roles.pile.empty()) report_pile(json);
    if (scene_.roles.top_body >= 0) report_stack(json);
    if (scene_.roles.chain) report_chain(json);
    if (soft_) soft_->report(json);
    if (scene_.roles.mesh_width > 0) json["joint_sep_pct"] = 100 * net_gap_ / scene_.roles.mesh_width;
}

}  // namespace bench
