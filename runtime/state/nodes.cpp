#include "state/nodes.h"

namespace taut {

const NodeLoad Nodes::kNoLoad;

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
    return node;
}

void Nodes::remove(uint32_t node) {
    clear_load(node);
    info[node] = {};
    mass.set(node, {});
    rest[node] = {};
    sleep[node] = {};
    if (const KinematicPath* path = find_path(node)) paths.erase(paths.begin() + (path - paths.data()));
    ids.destroy(node);
}

void Nodes::add_load(uint32_t node, const Vec3& force, const Vec3& torque) {
    if (applied.empty()) applied.resize(slots());
    applied[node].force += force;
    applied[node].torque += torque;
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
