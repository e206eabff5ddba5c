#include "state/nodes.h"

#include <Eigen/LU>
#include <cstring>
#include <utility>

namespace taut {

const NodeLoad Nodes::kNoLoad;

namespace {

// Of lists that are sorted by node.
template <class T>
void drop(Array<T>& list, uint32_t node) {
    const auto at = std::ranges::lower_bound(list, node, {}, &T::node);
    if (at != list.end() && at->node == node) list.erase(at);
}
template <class T>
void put(Array<T>& list, const T& value) {
    const auto at = std::ranges::lower_bound(list, value.node, {}, &T::node);
    if (at != list.end() && at->node == value.node)
        *at = value;
    else
        list.insert(at, value);
}

}  // namespace

uint32_t Nodes::add() {
    ids.reserve_one();
    const size_t slots = info.size() + 1;
    // Grow everything first: the part below cannot fail.
    if (info.capacity() < slots) {
        const size_t room = with_slack(slots) + 14;
        motion.reserve(room);
        mass.reserve(room);
        before.reserve(room);
        rest.reserve(room);
        sleep.reserve(room);
        active.reserve(room);
        info.reserve(room);
    }
    mass.reserve_values(1);
    for (Array<NodeLoad>* list : loads())
        if (!list->empty()) reserve_more(*list, 1);
    const uint32_t node = ids.create();
    if (node == info.size()) {
        info.emplace_back();
        motion.emplace_back();
        mass.add();
        for (Array<NodeLoad>* list : loads())
            if (!list->empty()) list->emplace_back();
        before.emplace_back();
        rest.emplace_back();
        sleep.emplace_back();
    } else {
        info[node] = {};
        motion[node] = {};
        clear_load(node);
        if (node < history.size()) history[node] = {};
        before[node] = {};
        rest[node] = {};
        sleep[node] = {};
    }
    listed_ = false;
    return node;
}

void Nodes::remove(uint32_t node) {
    clear_load(node);
    movable -= info[node].kind != NodeKind::fixed;
    info[node] = {};
    mass.set(node, {});
    set_rest(node, Rest::asleep);
    sleep[node] = {};
    if (const KinematicPath* path = find_path(node)) paths.erase(paths.begin() + (path - paths.data()));
    if (const FrozenNode* held = find_frozen(node)) frozen.erase(frozen.begin() + (held - frozen.data()));
    drop(names, node);
    drop(restraints, node);
    drop(locked, node);
    drop(spares, node);
    ids.destroy(node);
}

void Nodes::add_load(uint32_t node, const Vec3& force, const Vec3& torque) {
    if (applied.empty()) applied.resize(slots());
    applied[node].force += force;
    applied[node].torque += torque;
}

// Those that sleep, of which there may be many, are passed over eight at a time.
void Nodes::list_active() {
    if (listed_ && !all_) return;
    constexpr uint32_t kMany = 8;
    constexpr std::array<Rest, kMany> kAllAsleep = {Rest::asleep, Rest::asleep, Rest::asleep, Rest::asleep,
                                                    Rest::asleep, Rest::asleep, Rest::asleep, Rest::asleep};
    active.clear();
    active.reserve(slots());
    for (uint32_t node = 0; node < slots(); ++node) {
        if (!all_ && node + kMany <= slots() && std::memcmp(&rest[node], kAllAsleep.data(), kMany) == 0)
            node += kMany - 1;
        else if (rest[node] != Rest::asleep || (all_ && info[node].kind != NodeKind::dead && enabled(node)))
            active.push_back(node);
    }
    listed_ = !std::exchange(all_, false);
    ++lists;
}

void Nodes::freeze(uint32_t node, Divergence why) {
    mass.reserve_values(1);
    reserve_more(frozen, 1);
    const auto at = std::ranges::lower_bound(frozen, node, {}, &FrozenNode::node);
    frozen.insert(at, {node, info[node].kind, why, mass[node]});
    stay(node);
    clear_load(node);
    if (node < history.size()) history[node] = {};
    NodeMass none = mass[node];
    none.mass = none.inv_mass = 0;
    none.inertia = none.inv_inertia = {};
    mass.set(node, none);
    info[node].kind = NodeKind::fixed;
    --movable;
}

void Nodes::stay(uint32_t node) {
    const NodePose& last = before[node];
    motion[node] = {};
    motion[node].q = last.rotation;
    motion[node].x = centre_at(node, last);
}

void Nodes::let_go(uint32_t node) {
    mass.reserve_values(1);
    const FrozenNode held = *find_frozen(node);
    mass.set(node, held.mass);
    info[node].kind = held.kind;
    ++movable;
    sleep[node].quiet = 0;
    if (enabled(node)) set_rest(node, Rest::awake);
    frozen.erase(std::ranges::lower_bound(frozen, node, {}, &FrozenNode::node));
}

const FrozenNode* Nodes::find_frozen(uint32_t node) const {
    const auto at = std::ranges::lower_bound(frozen, node, {}, &FrozenNode::node);
    return at != frozen.end() && at->node == node ? &*at : nullptr;
}

const char* Nodes::name_of(uint32_t node) const {
    const NodeName* const name = find_in(names, node);
    return name ? name->text.data() : nullptr;
}

void Nodes::set_name(uint32_t node, const std::array<char, TAUT_BODY_NAME_SIZE>& text) {
    text[0] == 0 ? drop(names, node) : put(names, {node, text});
}

void Nodes::set_restraint(const Restraint& restraint) {
    restraint.any() ? put(restraints, restraint) : drop(restraints, restraint.node);
    info[restraint.node].restrained = restraint.any();
}

void Nodes::set_locks(uint32_t node, Locks locks) {
    locks.any() ? put(locked, LockedNode{node, locks.axes}) : drop(locked, node);
    info[node].locks = locks.axes;
}

Mat3 Nodes::free_inverse_inertia(uint32_t node, const Mat3& R) const {
    return free_inverse(R * mass[node].inertia.matrix() * R.transpose(), locks_of(node));
}

Mat3 free_inverse(Mat3 inertia, Locks locks) {
    // With nothing but a diagonal entry in what is locked, the rest of the inverse is that of the free block.
    const double size = inertia.trace();
    for (int i = 0; i < 3; ++i) {
        if (!locks.angular(i)) continue;
        inertia.row(i).setZero();
        inertia.col(i).setZero();
        inertia(i, i) = size;
    }
    Mat3 inverse = inertia.inverse();
    for (int i = 0; i < 3; ++i) {
        if (!locks.angular(i)) continue;
        inverse.row(i).setZero();
        inverse.col(i).setZero();
    }
    return inverse;
}

void Nodes::set_spare(const SpareMass& spare) { put(spares, spare); }

void Nodes::drop_spare(uint32_t node) { drop(spares, node); }

void Nodes::set_gravity_scale(uint32_t node, double scale) {
    mass.reserve_values(1);
    NodeMass own = mass[node];
    own.gravity_scale = scale;
    mass.set(node, own);
    if (find_frozen(node)) std::ranges::lower_bound(frozen, node, {}, &FrozenNode::node)->mass.gravity_scale = scale;
}

KinematicPath* Nodes::find_path(uint32_t node) {
    const auto at = std::ranges::lower_bound(paths, node, {}, &KinematicPath::node);
    return at != paths.end() && at->node == node ? &*at : nullptr;
}

KinematicPath& Nodes::path_of(uint32_t node) {
    const auto at = std::ranges::lower_bound(paths, node, {}, &KinematicPath::node);
    if (at != paths.end() && at->node == node) return *at;
    KinematicPath path;
    path.node = node;
    return *paths.insert(at, path);
}

}  // namespace taut
