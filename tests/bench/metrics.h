// Figures of a run, taken from poses and velocities alone: the same for every engine.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "engine.h"
#include "soft_metrics.h"

namespace bench {

// Meaning of each JSON field, for --help.
extern const char* const kFieldHelp;

// Of a chain or cable, so far.
struct ChainFigures {
    double gap_most = 0, gap_late = 0;  // largest joint gap, of the whole run and of its last 5 s [link lengths]
    double stretch_most = 0, stretch_late = 0;  // the whole chain's change of length, same windows [1]
    double energy = 1, energy_most = 1;         // now and at most; 1 is the start's, see energy_max in kFieldHelp
    bool blew_up = false;
};

class Metrics {
public:
    Metrics(const scenes::Scene& scene, const Engine& engine, uint32_t steps);

    void after_step(uint32_t step);  // counted from 0
    bool finite() const { return finite_ && (!soft_ || soft_->finite()); }
    const SoftMetrics& soft() const { return *soft_; }  // of a scene with cloths or solids
    ChainFigures chain() const;                         // of a scene that has one
    void report(nlohmann::ordered_json& json) const;

private:
    struct Overlaps {
        double mean = 0, max = 0;  // [m]
    };

    void read_motions();
    double energy_above_hanging() const;
    double moving_mass() const;
    void follow_chain(uint32_t step);
    void follow_net();
    double joint_gap(const scenes::Joint& joint) const;
    Overlaps overlaps() const;
    uint32_t escaped() const;
    double grain_radius() const;
    void report_chain(nlohmann::ordered_json& json) const;
    void report_pile(nlohmann::ordered_json& json) const;
    void report_stack(nlohmann::ordered_json& json) const;

    const scenes::Scene& scene_;
    const Engine& engine_;
    uint32_t last_second_, last_five_seconds_;  // first steps of the windows
    std::vector<Motion> motions_, start_;
    std::vector<Mass> masses_;
    std::vector<double> hang_height_;  // of each body's centre in the state that energies are counted from [m]
    bool finite_ = true;
    double rest_sum_ = 0;
    uint64_t rest_count_ = 0;
    // chain
    double energy_start_ = 0, energy_most_ = 0, energy_last_ = 0, energy_unit_ = 1;  // [J]
    double gap_most_ = 0, gap_late_ = 0, stretch_most_ = 0, stretch_late_ = 0;       // [m], [m], [1], [1]
    std::vector<double> crossings_;  // times at which the weight passes below the anchor [s]
    double side_ = 0;                // of the weight at the last step [m]
    double net_gap_ = 0;             // largest of a net's joints, of the whole run [m]
    std::optional<SoftMetrics> soft_;
};

}  // namespace bench
