#include "engine.h"
#include "scenes/taut_world.h"

namespace bench {

namespace {

class TautEngine : public Engine {
public:
    explicit TautEngine(const scenes::Scene& scene) : def_(scene.world), world_(scene) {}

    const char* name() const override { return "taut"; }
    const char* solver() const override { return taut_solver_name(def_.solver); }
    uint32_t substeps() const override { return def_.substeps; }
    void step() override { world_.step(); }

    Motion motion(size_t body) const override {
        Motion motion;
        taut_pose pose = world_.pose(body);
        motion.position = pose.position;
        motion.rotation = pose.rotation;
        scenes::check(taut_body_get_velocity(world_.bodies[body], &motion.linear_velocity, &motion.angular_velocity),
                      "reading a velocity");
        return motion;
    }

    Mass mass(size_t body) const override {
        float mass = 0;
        taut_vec3 centre{};
        Mass result;
        scenes::check(taut_body_get_mass(world_.bodies[body], &mass, &centre, &result.inertia), "reading a mass");
        result.mass = mass;
        return result;
    }

    void read_cloth(size_t index, SoftState& state) const override {
        read(world_.cloths[index], world_.cloth_vertices[index].size(), taut_cloth_get_points,
             taut_cloth_get_velocities, state);
    }

    void read_solid(size_t index, SoftState& state) const override {
        read(world_.solids[index], world_.solid_vertices[index].size(), taut_solid_get_points,
             taut_solid_get_velocities, state);
    }

    uint64_t state_hash() const override {
        uint64_t hash = 0;
        scenes::check(taut_world_get_state_hash(world_.world, &hash), "reading the state hash");
        return hash;
    }

    taut_world world() const override { return world_.world; }

    SolveTime solve_time() const override {
        taut_profile profile = world_.profile();
        return {static_cast<double>(profile.assemble_us) + static_cast<double>(profile.factor_us), profile.solves};
    }

    std::vector<StageTime> stage_times() const override {
        const taut_profile p = world_.profile();
        const auto ms = [](float us) { return 1e-3 * static_cast<double>(us); };
        return {{"broadphase", ms(p.broadphase_us)}, {"narrowphase", ms(p.narrowphase_us)},
                {"partition", ms(p.partition_us)},   {"predict", ms(p.predict_us)},
                {"assemble", ms(p.assemble_us)},     {"factor", ms(p.factor_us)},
                {"sweep", ms(p.sweep_us)},           {"commit", ms(p.commit_us)},
                {"publish", ms(p.publish_us)}};
    }

    uint64_t bytes() const override {
        uint64_t bytes = 0;
        scenes::check(taut_world_get_bytes(world_.world, &bytes), "reading how much memory the world holds");
        return bytes;
    }

    uint32_t asleep() const override {
        const taut_profile profile = world_.profile();
        return profile.bodies - profile.awake;
    }

    uint32_t quarantined() const override {
        taut_events events{};
        scenes::check(taut_world_get_events(world_.world, &events), "reading the events");
        return events.quarantined_count;
    }

private:
    template <class Handle, class Points, class Velocities>
    static void read(Handle handle, size_t size, Points points, Velocities velocities, SoftState& state) {
        auto count = static_cast<uint32_t>(size);
        state.points.resize(size);
        state.velocities.resize(size);
        scenes::check(points(handle, state.points.data(), count, &count), "reading vertices");
        scenes::check(velocities(handle, state.velocities.data(), count, &count), "reading velocities");
    }

    taut_world_def def_;
    scenes::TautWorld world_;
};

}  // namespace

void Engine::read_cloth(size_t, SoftState&) const { throw scenes::BadScene(name() + std::string(" has no cloths")); }
void Engine::read_solid(size_t, SoftState&) const { throw scenes::BadScene(name() + std::string(" has no solids")); }

std::unique_ptr<Engine> make_taut_engine(const scenes::Scene& scene) { return std::make_unique<TautEngine>(scene); }

}  // namespace bench
