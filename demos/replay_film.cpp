#include "replay_film.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>

#include "film.h"
#include "hud.h"
#include "recording.h"
#include "scenes/taut_world.h"
#include "world_view.h"

namespace demo {

namespace {

void print_log(taut_log_level level, const char* text, void*) {
    if (level != TAUT_LOG_INFO) std::fprintf(stderr, "taut: %s\n", text);
}

// A world that plays a recording, and its pictures.
class Replay {
public:
    explicit Replay(const Options& options) : options_(options), bytes_(read(options.replay)) {
        taut_replay_def def;
        taut_replay_def_init(&def);
        def.bytes = bytes_.data();
        def.size = bytes_.size();
        def.threads = options.threads;
        def.hooks.log = print_log;
        if (taut_replay_open(&def, &world_) != TAUT_OK) refuse();
        name_ = std::filesystem::path(options.replay).stem().string();
    }
    ~Replay() { taut_world_destroy(world_); }
    Replay(const Replay&) = delete;
    Replay& operator=(const Replay&) = delete;

    // To the end of the recording; draws no further than --frames.
    void go() {
        while (next()) {
            read_figures();
            if (options_.frames && state_.frame > *options_.frames) continue;
            if (!options_.render) continue;
            if (!film_) begin_film();
            view_->step(time_step_);
            const auto frame = static_cast<uint32_t>(state_.frame);
            if (frame % options_.every == 0 && frame >= options_.from) draw(frame);
        }
        if (film_) film_->finish();
    }

    bool same() const { return state_.status == TAUT_REPLAY_ENDED; }

    nlohmann::ordered_json json() const {
        nlohmann::ordered_json json = json_of(options_.replay, options_.threads, state_);
        json["bodies"] = profile_.bodies;
        json["joints"] = profile_.joints;
        json["mean_step_ms"] = step_sum_ms_ / static_cast<double>(std::max<uint64_t>(1, state_.frame));
        json["worst_step_ms"] = step_worst_ms_;
        json["worst_joint_error_mm"] = 1e3 * joint_error_;
        json["worst_penetration_mm"] = 1e3 * penetration_;
        if (film_) film_->describe(json);
        return json;
    }

    void print_summary() const {
        if (film_) film_->print_summary();
        std::fprintf(stderr, "%s\n", told(state_).c_str());
    }

private:
    static std::vector<char> read(const std::string& path) {
        try {
            return read_recording(path);
        } catch (const std::runtime_error& error) {
            throw NoRecording(error.what());
        }
    }

    [[noreturn]] void refuse() const { throw NoRecording(options_.replay + ": " + taut_last_error()); }

    bool next() {
        if (taut_replay_next(world_, &state_) != TAUT_OK) refuse();
        return state_.status == TAUT_REPLAY_STEPPED;
    }

    void read_figures() {
        profile_ = {};
        profile_.struct_size = sizeof profile_;
        scenes::check(taut_world_get_profile(world_, &profile_), "reading the profile");
        const double step_ms = 1e-3 * static_cast<double>(profile_.step_us);
        step_sum_ms_ += step_ms;
        step_worst_ms_ = std::max(step_worst_ms_, step_ms);
        joint_error_ = std::max(joint_error_, static_cast<double>(profile_.joint_error));
        penetration_ = std::max(penetration_, static_cast<double>(profile_.penetration));
        taut_world_def def;
        taut_world_def_init(&def);
        scenes::check(taut_world_get_def(world_, &def), "reading the world's def");
        time_step_ = def.time_step;
    }

    void begin_film() {
        film_ = std::make_unique<Film>(options_, name_, 1 / (static_cast<double>(time_step_) * options_.every));
        const float aspect = static_cast<float>(options_.width) / static_cast<float>(options_.height);
        view_ = std::make_unique<WorldView>(world_, film_->renderer(), aspect);
    }

    void draw(uint32_t frame) {
        list_.clear();
        view_->add(list_);
        if (options_.hud) {
            HudFigures hud;
            hud.scene = name_;
            hud.description = "recording, the same up to here";
            hud.frame = frame;
            hud.step_ms = 1e-3 * static_cast<double>(profile_.step_us);
            hud.budget_ms = 1e3 * static_cast<double>(time_step_);
            hud.joint_error = static_cast<double>(profile_.joint_error);
            hud.worst_joint_error = joint_error_;
            hud.has_joints = profile_.joints > 0;
            hud.bodies = profile_.bodies;
            hud.joints = profile_.joints;
            hud.pairs = profile_.touching;
            hud.points = profile_.points;
            hud.asleep = profile_.bodies - profile_.awake;
            add_hud(list_, hud);
        }
        film_->add(list_, frame - 1);
    }

    const Options& options_;
    std::vector<char> bytes_;
    std::string name_;
    taut_world world_{};
    taut_replay_state state_{};
    taut_profile profile_{};
    float time_step_ = 0;  // [s]
    double step_sum_ms_ = 0, step_worst_ms_ = 0, joint_error_ = 0, penetration_ = 0;
    std::unique_ptr<Film> film_;
    std::unique_ptr<WorldView> view_;
    render::DrawList list_;
};

}  // namespace

bool play(const Options& options) {
    Replay replay(options);
    replay.go();
    const std::string figures = replay.json().dump(2);
    std::printf("%s\n", figures.c_str());
    std::fflush(stdout);
    if (!options.json.empty()) {
        std::ofstream file(options.json);
        if (!(file << figures << '\n' << std::flush)) throw std::runtime_error("cannot write " + options.json);
    }
    replay.print_summary();
    return replay.same();
}

}  // namespace demo
