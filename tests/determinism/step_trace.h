// What the stages of a step leave behind, node by node: two runs compared tell where they part.
#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "base/hash.h"
#include "scenes/running_scene.h"
#include "world.h"

namespace determinism {

using taut::name_of;

// The first stage of a step after which two runs differ, and in it the first island.
struct Difference {
    taut::StageEnd end;
    uint32_t island;  // its smallest node; kNone: all of the world
};
std::ostream& operator<<(std::ostream& out, const Difference& difference);

// Looks on at the last step of one world.
class StepTrace final : public taut::StageObserver {
public:
    void clear() { records_.clear(); }
    void after(taut::World& world, const taut::StageEnd& end) override;

    // Of a step of two worlds of the same scene.
    static std::optional<Difference> first_difference(const StepTrace& a, const StepTrace& b);

private:
    struct Record {
        taut::StageEnd end;
        std::vector<uint64_t> by_node;
    };
    void find_islands(const taut::World& world);
    uint32_t root_of(uint32_t node) const;

    std::vector<Record> records_;
    std::vector<uint32_t> parent_;  // of the step's islands: the smallest node is the root
};

// A scene of which every step is traced.
class TracedScene : public lab::RunningScene {
public:
    // An observer in place of the trace passes on to it what it sees.
    explicit TracedScene(scenes::Scene plan, taut::StageObserver* instead = nullptr);

    void step() {
        trace.clear();
        lab::RunningScene::step();
    }
    uint64_t hash() const;

    StepTrace trace;
};

// The world behind a handle, which nothing else may use meanwhile.
void observe(taut_world handle, taut::StageObserver* observer);

// The first field in which the states of two worlds differ.
std::string first_difference(taut_world one, taut_world other);

}  // namespace determinism
