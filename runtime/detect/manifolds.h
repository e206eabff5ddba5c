// The manifolds of one pair: found in full, or reused.
#pragma once

#include <algorithm>
#include <atomic>
#include <iterator>
#include <optional>
#include <span>

#include "collision/internal_face.h"
#include "detect/impact.h"
#include "state/colliders.h"
#include "state/nodes.h"
#include "state/pairs.h"
#include "state/shapes.h"

namespace taut {

// What contacts are found from.
struct Detection {
    const Nodes& nodes;
    const Colliders& colliders;
    const Shapes& shapes;
    Pairs& pairs;
    double time;  // ahead [s]
    double lead;  // of contacts that move over their surfaces, their mean age in the time ahead [s]; see Shaped

    double substep() const { return time - 2 * lead; }
};

// Two shapes as they stand in a pair, or as they will where they meet later in the time ahead.
//
// Or as they will in a lead time. Contacts are found once a frame and serve all its substeps. Where a round body rocks
// or rolls, its contact moves over it and turns as it does: found at the frame's beginning, what brings the body back
// always comes late, and it swings wider and wider (x'' = -k x(t - T) gains energy as if driven by k T x'). Found where
// the bodies will be halfway through the substeps, it comes in time.
class Shaped {
public:
    Shaped(const Detection& of, const PairEnds& pair, bool fast, double lead = 0);
    // With points that were found before, where they meet at this moment [s]; 0: now.
    struct Met {
        float then;
    };
    Shaped(const Detection& of, const PairEnds& pair, Met met);
    Shaped(const Shaped&) = delete;
    Shaped& operator=(const Shaped&) = delete;

    const collision::Placement& at_a() const { return *at_a_; }
    const collision::Placement& at_b() const { return *at_b_; }

    // Returns, if it finds no points, how far apart the two are at least [m]; 0: not known.
    float find_points(collision::PairCache& cache, collision::Manifold& manifold) const;
    void find_parts(collision::Parts& parts) const;
    void find_open_points(bool solid_is_b, const collision::SolidContact& contact, const collision::Cover& cover,
                          collision::Manifold& manifold) const;

    float then() const { return then_; }
    double lead() const { return lead_; }
    // Whether what is found is of the present, between two bodies: it can be reused.
    bool can_be_kept() const { return then_ == 0 && lead_ == 0 && !spans_; }
    void bring_to_present(Pair& pair) const {
        if (pair.then > 0) encounter_->bring_to_present(pair);
    }

private:
    Shaped(const Detection& of, const PairEnds& pair);
    void look_ahead(const Detection& of, const PairEnds& pair);
    void place_after(double time);

    const collision::Shape &a_, &b_;
    const collision::Placement *at_a_, *at_b_;
    float margin_;
    bool spans_;
    double lead_ = 0;                     // [s]
    float then_ = 0;                      // [s]; 0: as they stand; infinite: they do not meet
    std::optional<Encounter> encounter_;  // of fast ones, and with a lead
    collision::Placement met_[2];         // where they meet, or will be
};

// The first points of pairs until they get records. Who comes first takes the next place; where none is left, the
// points are found again once there is a record.
class Arrivals {
public:
    explicit Arrivals(Array<Arrival>& records) : records_(records) {}
    // Null: none is left.
    Arrival* take() {
        const uint32_t index = taken_.fetch_add(1, std::memory_order_relaxed);
        return index < records_.size() ? &records_[index] : nullptr;
    }
    // How many were asked for.
    uint32_t number() const { return taken_.load(std::memory_order_relaxed); }
    // Those taken, in the order of their keys.
    std::span<const Arrival> sort() {
        const auto end = records_.begin() + std::min<ptrdiff_t>(number(), std::ssize(records_));
        std::sort(records_.begin(), end, [](const Arrival& one, const Arrival& other) { return one.key < other.key; });
        return {records_.begin(), end};
    }

private:
    Array<Arrival>& records_;
    std::atomic<uint32_t> taken_ = 0;
};

// The manifold of a pair without a surface: it is found, and takes over what the last one had.
class Finding {
public:
    Finding(const Detection& of, bool fast, NearPair& near, Pair& pair);
    Finding(const Detection& of, bool fast, double lead, NearPair& near, Pair& pair);
    Finding(const Finding&) = delete;
    Finding& operator=(const Finding&) = delete;

    void take_over(const Detection& of) const;

private:
    NearPair& near_;
    Pair& pair_;
    const collision::Manifold old_;
    const Shaped shaped_;
};
inline void find_points(const Detection& of, bool fast, NearPair& near, Pair& pair) {
    Finding(of, fast, near, pair).take_over(of);
}

// Many pairs: some are found before they take over, for a processor's first cache holds the code of either but not of
// both.
class Findings {
public:
    explicit Findings(const Detection& of) : of_(of) {}

    void find(bool fast, NearPair& near, Pair& pair) {
        if (count_ == kTogether) take_over();
        list_[count_++].emplace(of_, fast, near, pair);
    }
    void take_over() {
        for (size_t i = 0; i < count_; ++i) list_[i]->take_over(of_);
        count_ = 0;
    }

private:
    static constexpr size_t kTogether = 32;

    const Detection& of_;
    std::optional<Finding> list_[kTogether];
    size_t count_ = 0;
};

// Whether a pair that has no record gets points: they are among the arrivals. If there is no place left, the cache
// stays as it was, so that whoever finds the points again starts from the same.
bool gets_points(const Detection& of, Arrivals& arrivals, NearPair& near);
// A record with points that arrived, or without: then they are found again.
void admit(const Detection& of, NearPair& near, Pair& pair);
// The parts that a pair with a surface touches, in place of its records of the last frame.
void find_parts(const Detection& of, NearPair& near);
// A part of a pair whose parts were just found again: one that is not among them loses its points. Whether it is kept.
bool refresh_part(const Shaped& shaped, const Detection& of, Pair& pair);

// Where a pair's points are counted from: the origin of node a's body, at the placement of its collider.
Vec3 origin_of_points(const Detection& of, const Pair& pair);
// Points on open faces in place of those on internal ones, without impulses, or none; detect/internal_faces.h.
void find_open_points(const Detection& of, bool solid_is_b, const collision::SolidContact& contact,
                      const collision::Cover& cover, Pair& pair);

// Brings a manifold that NearPair::kept holds to the present; false if it is to be found again.
bool reuse(const Detection& of, const NearPair& near, Pair& pair);
// All manifolds of a pair.
bool reuse(const Detection& of, NearPair& near);

// A pair without points has no records and touches no more.
void lose_points(const Detection& of, NearPair& near);

}  // namespace taut
