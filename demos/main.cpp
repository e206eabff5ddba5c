// taut-demo: runs a scene of Taut and renders it without a window.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "film.h"
#include "hud.h"
#include "options.h"
#include "render/egl_context.h"
#include "replay_film.h"
#include "scene_export.h"
#include "scene_view.h"
#include "scenes/catalogue.h"

namespace demo {

namespace {

enum ExitCode { kFine = 0, kRunFailed = 1, kBadArguments = 2, kNoEgl = 3 };

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

// Figures over all frames so far.
struct Figures {
    uint32_t frames = 0;
    double step_sum_ms = 0, step_worst_ms = 0;
    double joint_error = 0, penetration = 0;  // worst [m]
    uint32_t quarantined = 0;
};

void print_log(taut_log_level level, const char* text, void*) {
    std::fprintf(stderr, "taut %s: %s\n",
                 level == TAUT_LOG_ERROR     ? "error"
                 : level == TAUT_LOG_WARNING ? "warning"
                                             : "info",
                 text);
}

scenes::Scene scene_of(const Options& options) {
    scenes::Scene scene = scenes::make_scene(
        options.scene, {options.seed, options.mesh, options.swept, options.from_point, options.line_search});
    if (options.substeps) scene.world.substeps = *options.substeps;
    if (options.solver) scene.world.solver = scenes::solver_named(*options.solver);
    scene.world.hooks.log = print_log;
    scene.world.threads = options.threads;
    scene.world.sleeping = options.sleep ? 1 : 0;
    return scene;
}

// The same scene without geometric stiffness, drawn beside it.
class Twin {
public:
    Twin(const scenes::Scene& scene, render::Renderer& renderer)
        : scene_(without_stiffness(scene)), world_(scene_), view_(scene_, world_, renderer) {}

    void step() {
        world_.step();
        joint_error_ = world_.joint_error();
        worst_ = std::fmax(worst_, joint_error_);
    }
    SceneView& view() { return view_; }
    double joint_error() const { return joint_error_; }
    double worst_joint_error() const { return worst_; }
    nlohmann::ordered_json json() const {
        return {{"worst_joint_error_mm", 1e3 * worst_}, {"quarantined", world_.quarantined}};
    }

private:
    static scenes::Scene without_stiffness(scenes::Scene scene) {
        scene.world.geometric_stiffness = 0;
        return scene;
    }

    scenes::Scene scene_;
    scenes::TautWorld world_;
    SceneView view_;
    double joint_error_ = 0, worst_ = 0;  // [m]
};

// What a world goes through, as a file.
class RecordFile {
public:
    RecordFile(const std::string& path) : path_(path) {
        if (!path.empty() && !file_.open(path, std::ios::binary | std::ios::out | std::ios::trunc))
            throw std::runtime_error("cannot write " + path);
    }
    void begin(taut_world world) {
        if (path_.empty()) return;
        taut_record_def def;
        taut_record_def_init(&def);
        def.write = [](const void* bytes, uint64_t size, void* self) -> int32_t {
            const auto count = static_cast<std::streamsize>(size);
            return static_cast<RecordFile*>(self)->file_.sputn(static_cast<const char*>(bytes), count) == count;
        };
        def.user_data = this;
        scenes::check(taut_world_record(world, &def), "recording");
    }
    void end(taut_world world) {
        if (path_.empty()) return;
        scenes::check(taut_world_end_recording(world), "ending the recording");
        if (!file_.close()) throw std::runtime_error("cannot write " + path_);
    }

private:
    std::string path_;
    std::filebuf file_;
};

// One film: world, renderer and files.
class Run {
public:
    Run(const Options& options, const scenes::Scene& scene)
        : options_(options),
          scene_(scene),
          frames_(options.frames.value_or(scene.steps)),
          record_file_(options.record),
          world_(scene, [this](taut_world world) { record_file_.begin(world); }) {
        if (!options.gltf.empty()) gltf_ = std::make_unique<GltfExport>(scene, world_);
        if (!options.csv.empty()) table_ = std::make_unique<PoseTable>(options.csv, world_);
        record(0);
        if (!options.render) return;
        film_ = std::make_unique<Film>(options, scene.name, 1.0 / (scene.world.time_step * options.every));
        view_ = std::make_unique<SceneView>(scene, world_, film_->renderer());
        list_.camera = view_->camera();
        if (options.compare)
            set_up_twin();
        else if (options.follow || !scene.camera.follow.empty())
            view_->follow(static_cast<float>(options.width) / static_cast<float>(options.height));
    }

    void go() {
        for (uint32_t frame = 0; frame < frames_; ++frame) {
            step();
            if (gltf_) gltf_->watch();
            if ((frame + 1) % options_.every == 0) {
                record(frame + 1);
                if (film_ && frame + 1 >= options_.from) draw(frame);
            }
            show_progress(frame + 1);
        }
        if (film_) film_->finish();
        if (gltf_) gltf_->write(options_.gltf);
        if (table_) table_->finish();
        record_file_.end(world_.world);
    }

    nlohmann::ordered_json json() const;
    void print_summary() const;
    const Figures& figures() const { return figures_; }

private:
    // Both in view: further off, each in the middle of its half of the picture.
    void set_up_twin() {
        constexpr float kFurther = 1.45f;
        twin_ = std::make_unique<Twin>(scene_, film_->renderer());
        render::Camera& camera = list_.camera;
        const render::Vec3 back = (camera.eye - camera.target) * kFurther;
        camera.eye = camera.target + back;
        const float aspect = static_cast<float>(options_.width) / static_cast<float>(options_.height);
        const float half_width = length(back) * std::tan(0.5f * camera.vertical_fov) * aspect;
        aside_ = render::view_axes(render::normalised(back * -1.0f)).right * (0.5f * half_width);
        render::Stage stage = view_->stage();
        const render::Vec3 reach = {std::fabs(aside_.x), 0, std::fabs(aside_.z)};
        stage.low = stage.low - reach;
        stage.high = stage.high + reach;
        film_->renderer().set_stage(stage);
    }

    void add_scene(SceneView& view, bool tension, render::Vec3 offset) {
        const size_t first = list_.instances.size(), first_corner = list_.surfaces.size();
        view.add_bodies(list_, tension);
        view.add_joints(list_, tension);
        view.add_cables(list_, tension);
        view.add_softs(list_);
        view.add_curves(list_);
        for (size_t i = first; i < list_.instances.size(); ++i)
            list_.instances[i].position = list_.instances[i].position + offset;
        for (size_t i = first_corner; i < list_.surfaces.size(); ++i)
            list_.surfaces[i].position = list_.surfaces[i].position + offset;
    }

    // The world after so many steps.
    void record(uint32_t steps) {
        const double time = steps * static_cast<double>(scene_.world.time_step);
        if (gltf_) gltf_->record(time);
        if (table_) table_->record(steps, time);
    }

    void step() {
        if (twin_) twin_->step();
        auto begin = Clock::now();
        world_.step();
        step_ms_ = ms_since(begin);
        if (view_) view_->step();
        profile_ = world_.profile();
        ++figures_.frames;
        figures_.step_sum_ms += step_ms_;
        figures_.step_worst_ms = std::fmax(figures_.step_worst_ms, step_ms_);
        joint_error_ = world_.joint_error();
        figures_.joint_error = std::fmax(figures_.joint_error, joint_error_);
        figures_.penetration = std::fmax(figures_.penetration, profile_.penetration);
        figures_.quarantined = world_.quarantined;
        if (!options_.curves) return;
        curves_[0].values.push_back(static_cast<float>(1e-3 * world_.energy()));
        curves_[1].values.push_back(static_cast<float>(1e3 * joint_error_));
        curves_[2].values.push_back(static_cast<float>(step_ms_));
    }

    void draw(uint32_t frame) {
        list_.clear();
        if (!twin_) list_.camera = view_->camera();
        bool tension = options_.tension.value_or(has_forces());
        add_scene(*view_, tension, aside_ * -1.0f);
        if (twin_) add_scene(twin_->view(), tension, aside_);
        if (options_.contacts && !twin_) view_->add_contacts(list_);
        if (options_.hud) add_figures(frame);
        if (options_.hud && tension && has_forces())
            add_tension_legend(list_, view_->tension_scale(), {options_.width, options_.height});
        if (options_.hud && options_.curves) add_curves(list_, curves_, frames_, {options_.width, options_.height});
        if (options_.hud) add_soft_legend(list_, scene_, {options_.width, options_.height});
        if (options_.hud && twin_) add_captions();
        film_->add(list_, frame);
    }

    void add_captions() {
        const render::HudCanvas canvas(options_.width, options_.height);
        add_caption(list_, {"with geometric stiffness", joint_error_, figures_.joint_error}, 0.25f * canvas.width,
                    canvas);
        add_caption(list_, {"without", twin_->joint_error(), twin_->worst_joint_error()}, 0.75f * canvas.width, canvas);
    }

    void add_figures(uint32_t frame) {
        HudFigures hud;
        hud.scene = scene_.name;
        hud.description = scene_.description;
        hud.frame = frame + 1;
        hud.frames = frames_;
        hud.time = (frame + 1) * static_cast<double>(scene_.world.time_step);
        hud.step_ms = step_ms_;
        hud.budget_ms = 1000.0 / 60.0;
        hud.joint_error = joint_error_;
        hud.worst_joint_error = figures_.joint_error;
        hud.has_joints =
            !scene_.cables.empty() || std::any_of(scene_.joints.begin(), scene_.joints.end(),
                                                  [](const scenes::Joint& joint) { return joint.compliance <= 0; });
        hud.bodies = profile_.bodies;
        hud.joints = profile_.joints;
        hud.broken = world_.broken.size();
        hud.pairs = profile_.touching;
        hud.points = contact_count();
        hud.asleep = options_.sleep ? profile_.bodies - profile_.awake : 0;
        add_hud(list_, hud);
    }

    // Those of what sleeps too, which the profile leaves out.
    uint32_t contact_count() const {
        if (!options_.sleep) return profile_.points;
        uint32_t count = 0;
        taut_world_get_contacts(world_.world, nullptr, 0, &count);  // TAUT_TOO_SMALL tells the number
        return count;
    }

    bool has_forces() const { return !scene_.joints.empty() || !scene_.cables.empty(); }

    void show_progress(uint32_t done) const {
        if (!isatty(STDERR_FILENO)) return;
        std::fprintf(stderr, "\r%s: frame %u/%u, step %.2f ms ", scene_.name.c_str(), done, frames_, step_ms_);
        if (done == frames_) std::fputc('\n', stderr);
    }

    const Options& options_;
    const scenes::Scene& scene_;
    uint32_t frames_;
    RecordFile record_file_;
    scenes::TautWorld world_;
    std::unique_ptr<Film> film_;
    std::unique_ptr<SceneView> view_;
    std::unique_ptr<Twin> twin_;
    render::Vec3 aside_{};  // from the middle to the twin [m]
    std::unique_ptr<GltfExport> gltf_;
    std::unique_ptr<PoseTable> table_;
    render::DrawList list_;
    taut_profile profile_{};
    double step_ms_ = 0, joint_error_ = 0;
    Figures figures_;
    std::vector<HudCurve> curves_ = {
        {"motion and height [kJ]", {}, false}, {"joint error [mm]", {}, true}, {"step [ms]", {}, true}};
};

nlohmann::ordered_json Run::json() const {
    uint64_t hash = 0;
    scenes::check(taut_world_get_state_hash(world_.world, &hash), "reading the state hash");
    char hash_text[20];
    std::snprintf(hash_text, sizeof hash_text, "%016llx", static_cast<unsigned long long>(hash));
    double frames = figures_.frames;
    nlohmann::ordered_json json;
    json["scene"] = scene_.name;
    json["solver"] = taut_solver_name(scene_.world.solver);
    json["frames"] = figures_.frames;
    json["threads"] = scene_.world.threads;
    json["bodies"] = profile_.bodies;
    json["joints"] = profile_.joints;
    json["mean_step_ms"] = figures_.step_sum_ms / frames;
    json["worst_step_ms"] = figures_.step_worst_ms;
    json["worst_joint_error_mm"] = 1e3 * figures_.joint_error;
    json["broken_joints"] = world_.broken.size();
    json["worst_penetration_mm"] = 1e3 * figures_.penetration;
    json["quarantined"] = figures_.quarantined;
    json["state_hash"] = hash_text;
    if (twin_) json["without_geometric_stiffness"] = twin_->json();
    if (gltf_) json["gltf"] = options_.gltf;
    if (table_) json["csv"] = options_.csv;
    if (film_) film_->describe(json);
    return json;
}

void Run::print_summary() const {
    if (film_) film_->print_summary();
    std::fprintf(stderr, "step: mean %.3f ms, worst %.3f ms\n", figures_.step_sum_ms / figures_.frames,
                 figures_.step_worst_ms);
}

int run(const Options& options) {
    if (!options.replay.empty()) return play(options) ? kFine : kRunFailed;
    scenes::Scene scene = scene_of(options);
    Run film(options, scene);
    film.go();
    std::string figures = film.json().dump(2);
    std::printf("%s\n", figures.c_str());
    std::fflush(stdout);
    if (!options.json.empty()) {
        std::ofstream file(options.json);
        if (!(file << figures << '\n' << std::flush)) throw std::runtime_error("cannot write " + options.json);
    }
    film.print_summary();
    if (film.figures().quarantined == 0) return kFine;
    std::fprintf(stderr, "taut-demo: %u bodies became non-finite and were frozen\n", film.figures().quarantined);
    return kRunFailed;
}

}  // namespace

}  // namespace demo

int main(int argc, char** argv) {
    int code = 0;
    std::optional<demo::Options> options = demo::read_options(argc, argv, &code);
    if (!options) return code;
    try {
        return demo::run(*options);
    } catch (const scenes::BadScene& error) {
        std::fprintf(stderr, "taut-demo: %s\n", error.what());
        return demo::kBadArguments;
    } catch (const demo::NoRecording& error) {
        std::fprintf(stderr, "taut-demo: %s\n", error.what());
        return demo::kBadArguments;
    } catch (const render::NoEglDevice& error) {
        std::fprintf(stderr, "taut-demo: %s\n", error.what());
        return demo::kNoEgl;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "taut-demo: %s\n", error.what());
        return demo::kRunFailed;
    }
}
