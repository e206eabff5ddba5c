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
    if (!load.empty()) reserve_more(load, 1);
    const uint32_t node = ids.create();
    if (node == info.size()) {
        info.emplace_back();
        motion.emplace_back();
        mass.add();
        if (!load.empty()) load.emplace_back();
        before.emplace_back();
        rest.emplace_back();
        sleep.emplace_back();
    } else {
        info[node] = {};
        motion[node] = {};
        clear_load(node);
        before[node] = {};
        rest[node] = {};
        sleep[node] = {};
    }
    return node;
}

void Nodes::remove(uint32_t node) {
    info[node] = {};
    mass.set(node, {});
    rest[node] = {};
    sleep[node] = {};
    ids.destroy(node);
}

void Nodes::add_load(uint32_t node, const Vec3& force, const Vec3& torque) {
    if (load.empty()) load.resize(slots());
    load[node].force += force;
    load[node].torque += torque;
}

}  // namespace taut
