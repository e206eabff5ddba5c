#include "state/nodes.h"

namespace taut {

uint32_t Nodes::add() {
    ids.reserve_one();
    const size_t slots = info.size() + 1;
    // Grow everything first: the part below cannot fail.
    if (info.capacity() < slots) {
        const size_t room = slots + slots / 4 + 14;
        motion.reserve(room);
        mass.reserve(room);
        load.reserve(room);
        before.reserve(room);
        rest.reserve(room);
        sleep.reserve(room);
        info.reserve(room);
    }
    const uint32_t node = ids.create();
    if (node == info.size()) {
        info.emplace_back();
        motion.emplace_back();
        mass.emplace_back();
        load.emplace_back();
        before.emplace_back();
        rest.emplace_back();
        sleep.emplace_back();
    } else {
        info[node] = {};
        motion[node] = {};
        mass[node] = {};
        load[node] = {};
        before[node] = {};
        rest[node] = {};
        sleep[node] = {};
    }
    return node;
}

void Nodes::remove(uint32_t node) {
    info[node] = {};
    rest[node] = {};
    sleep[node] = {};
    ids.destroy(node);
}

}  // namespace taut
