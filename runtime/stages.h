// The stages of a step, and an onlooker between them: how tests find where two runs part.
#pragma once

#include <cstddef>
#include <cstdint>

namespace taut {

struct World;

// In the order of the step; predict to relax once for each substep of each group.
enum class Stage : uint8_t {
    bounds,
    pairs,
    contacts,
    partition,
    predict,
    assemble,
    solve,
    commit,
    relax,
    publish,
    sleep
};

constexpr const char* name_of(Stage stage) {
    constexpr const char* kNames[] = {"bounds", "pairs",  "contacts", "partition", "predict", "assemble",
                                      "solve",  "commit", "relax",    "publish",   "sleep"};
    return kNames[static_cast<size_t>(stage)];
}

struct StageEnd {
    Stage stage;
    uint32_t group = 0, substep = 0;  // of predict to relax
};

class StageObserver {
public:
    virtual void after(World& world, const StageEnd& end) = 0;

protected:
    ~StageObserver() = default;
};

// To the world's observer; in builds with checks, invariants are looked at first.
void tell(World& world, const StageEnd& end);

}  // namespace taut
