// The same scenes in the Open Dynamics Engine with its default settings (ERP 0.2, CFM 1e-10, no damping; 20 sweeps
// of quickstep) and one step a frame. Friction of joints is left out.
#include <ode/ode.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "peer.h"
#include "vector.h"

namespace bench {

namespace {

// ODE's global state, up while the program runs.
void start_library() {
    static const struct Library {
        Library() {
            dInitODE2(0);
            dAllocateODEDataForThread(dAllocateMaskAll);
        }
        ~Library() { dCloseODE(); }
        Library(const Library&) = delete;
        Library& operator=(const Library&) = delete;
    } library;
}

struct Contactor {
    double friction = 0;
    int32_t group = 0;
};

double real(float v) { return static_cast<double>(v); }

class OdeEngine : public Engine {
public:
    OdeEngine(const scenes::Scene& scene, uint32_t substeps, OdeSolver solver)
        : solver_(solver), substeps_(substeps), step_(real(scene.world.time_step) / substeps) {
        if (!scene.cables.empty())
            throw scenes::BadScene("--engine ode: scene '" + scene.name + "' has cables, which ODE lacks");
        if (!scene.cloths.empty() || !scene.solids.empty())
            throw scenes::BadScene("--engine ode: scene '" + scene.name + "' has cloths or solids, which ODE lacks");
        start_library();
        world_ = dWorldCreate();
        space_ = dHashSpaceCreate(nullptr);
        contacts_ = dJointGroupCreate(0);
        dWorldSetGravity(world_, real(scene.world.gravity.x), real(scene.world.gravity.y), real(scene.world.gravity.z));
        contactors_.reserve(scene.bodies.size());  // geoms point into it
        try {
            for (const scenes::Body& body : scene.bodies) add(scene, body);
            for (const scenes::Joint& joint : scene.joints) add(joint);
        } catch (...) {
            release();
            throw;
        }
    }
    ~OdeEngine() override { release(); }
    OdeEngine(const OdeEngine&) = delete;
    OdeEngine& operator=(const OdeEngine&) = delete;

    const char* name() const override { return "ode"; }
    const char* solver() const override { return solver_ == OdeSolver::step ? "dWorldStep" : "dWorldQuickStep"; }
    uint32_t substeps() const override { return substeps_; }
    void step() override {
        for (uint32_t i = 0; i < substeps_; ++i) {
            dSpaceCollide(space_, this, &OdeEngine::touch);
            if (solver_ == OdeSolver::step)
                dWorldStep(world_, step_);
            else
                dWorldQuickStep(world_, step_);
            dJointGroupEmpty(contacts_);
        }
    }

    Motion motion(size_t body) const override {
        dBodyID id = bodies_[body];
        if (!id) return {};
        auto vec = [](const dReal* v) -> taut_vec3 {
            return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
        };
        const dReal *p = dBodyGetPosition(id), *q = dBodyGetQuaternion(id);  // w first
        return {
            {p[0], p[1], p[2]},
            {static_cast<float>(q[1]), static_cast<float>(q[2]), static_cast<float>(q[3]), static_cast<float>(q[0])},
            vec(dBodyGetLinearVel(id)),
            vec(dBodyGetAngularVel(id))};
    }

    Mass mass(size_t body) const override {
        if (!bodies_[body] || dBodyIsKinematic(bodies_[body])) return {};
        dMass mass;
        dBodyGetMass(bodies_[body], &mass);
        return {
            mass.mass,
            {static_cast<float>(mass.I[0]), static_cast<float>(mass.I[5]), static_cast<float>(mass.I[10]), 0, 0, 0}};
    }

    uint64_t state_hash() const override { return hash_of_motions(*this, bodies_.size()); }

private:
    void release() {
        dJointGroupDestroy(contacts_);
        dSpaceDestroy(space_);
        dWorldDestroy(world_);
    }

    static void touch(void* self, dGeomID a, dGeomID b) { static_cast<OdeEngine*>(self)->touch(a, b); }
    void touch(dGeomID a, dGeomID b) {
        constexpr int kMostPoints = 8;
        const auto& one = *static_cast<const Contactor*>(dGeomGetData(a));
        const auto& other = *static_cast<const Contactor*>(dGeomGetData(b));
        dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
        if (one.group < 0 && one.group == other.group) return;
        if (body_a && body_b && dAreConnectedExcluding(body_a, body_b, dJointTypeContact)) return;
        std::array<dContactGeom, kMostPoints> points;
        int count = dCollide(a, b, kMostPoints, points.data(), sizeof points[0]);
        for (int i = 0; i < count; ++i) {
            dContact contact{};
            contact.geom = points[static_cast<size_t>(i)];
            contact.surface.mode = dContactApprox1;  // mu is a coefficient of friction
            contact.surface.mu = std::sqrt(one.friction * other.friction);
            dJointAttach(dJointCreateContact(world_, contacts_, &contact), body_a, body_b);
        }
    }

    dGeomID make_geom(const scenes::Shape& shape, const taut_pos& at) {
        switch (shape.kind) {
            case scenes::ShapeKind::plane: {
                double x = real(shape.normal.x), y = real(shape.normal.y), z = real(shape.normal.z);
                double length = std::sqrt(x * x + y * y + z * z);
                return dCreatePlane(space_, x / length, y / length, z / length,
                                    (x * at.x + y * at.y + z * at.z) / length);
            }
            case scenes::ShapeKind::box:
                return dCreateBox(space_, 2 * real(shape.half_extents.x), 2 * real(shape.half_extents.y),
                                  2 * real(shape.half_extents.z));
            case scenes::ShapeKind::sphere:
                return dCreateSphere(space_, real(shape.radius));
            case scenes::ShapeKind::capsule:
            case scenes::ShapeKind::hull:
            case scenes::ShapeKind::cylinder:
            case scenes::ShapeKind::cone:
            case scenes::ShapeKind::tapered_capsule:
            case scenes::ShapeKind::scaled_hull:
            case scenes::ShapeKind::mesh:
            case scenes::ShapeKind::height_field:
                break;
        }
        throw scenes::BadScene("--engine ode runs scenes of boxes, spheres and planes only");
    }

    void add(const scenes::Scene& scene, const scenes::Body& body) {
        if (body.kind == TAUT_BODY_PARTICLE)
            throw scenes::BadScene("--engine ode: scene '" + scene.name +
                                   "' needs particles and rods, which ODE lacks");
        const scenes::Shape& shape = scene.shapes[static_cast<size_t>(body.shape)];
        contactors_.push_back({real(body.friction), body.group});
        dGeomID geom = make_geom(shape, body.position);
        dGeomSetData(geom, &contactors_.back());
        bodies_.push_back(nullptr);
        if (shape.kind == scenes::ShapeKind::plane) return;
        const dQuaternion q = {real(body.rotation.w), real(body.rotation.x), real(body.rotation.y),
                               real(body.rotation.z)};
        dBodyID id = bodies_.back() = dBodyCreate(world_);
        dBodySetPosition(id, body.position.x, body.position.y, body.position.z);
        dBodySetQuaternion(id, q);
        dGeomSetBody(geom, id);
        if (body.kind != TAUT_BODY_DYNAMIC) {
            dBodySetKinematic(id);
            return;
        }
        dMass mass;
        if (shape.kind == scenes::ShapeKind::box)
            dMassSetBoxTotal(&mass, mass_of(scene, body), 2 * real(shape.half_extents.x),
                             2 * real(shape.half_extents.y), 2 * real(shape.half_extents.z));
        else
            dMassSetSphereTotal(&mass, mass_of(scene, body), real(shape.radius));
        dBodySetMass(id, &mass);
        const taut_vec3 &v = body.linear_velocity, &w = body.angular_velocity;
        dBodySetLinearVel(id, real(v.x), real(v.y), real(v.z));
        dBodySetAngularVel(id, real(w.x), real(w.y), real(w.z));
    }

    void add(const scenes::Joint& joint) {
        dBodyID b = bodies_[static_cast<size_t>(joint.body_b)];
        dBodyID a = joint.body_a == scenes::kWorld ? nullptr : bodies_[static_cast<size_t>(joint.body_a)];
        dVector3 at;  // where both anchors are at the start
        dBodyGetRelPointPos(b, joint.anchor_b.x, joint.anchor_b.y, joint.anchor_b.z, at);
        if (joint.kind == TAUT_JOINT_BALL) {
            dJointID made = dJointCreateBall(world_, nullptr);
            dJointAttach(made, b, a);
            dJointSetBallAnchor(made, at[0], at[1], at[2]);
        } else if (joint.kind == TAUT_JOINT_UNIVERSAL && a) {
            add_universal(joint, a, b, at);
        } else {
            throw scenes::BadScene("--engine ode: ball joints, and universal ones between bodies, only");
        }
    }

    // Turns about x of a's frame and y of b's.
    void add_universal(const scenes::Joint& joint, dBodyID a, dBodyID b, const dVector3& at) {
        const Vec x = rotate(joint.rotation_a, {1, 0, 0}), y = rotate(joint.rotation_b, {0, 1, 0});
        dJointID made = dJointCreateUniversal(world_, nullptr);
        dJointAttach(made, a, b);
        dJointSetUniversalAnchor(made, at[0], at[1], at[2]);
        dVector3 axis;
        dBodyVectorToWorld(a, x.x, x.y, x.z, axis);
        dJointSetUniversalAxis1(made, axis[0], axis[1], axis[2]);
        dBodyVectorToWorld(b, y.x, y.y, y.z, axis);
        dJointSetUniversalAxis2(made, axis[0], axis[1], axis[2]);
    }

    OdeSolver solver_;
    uint32_t substeps_;
    double step_;
    dWorldID world_ = nullptr;
    dSpaceID space_ = nullptr;
    dJointGroupID contacts_ = nullptr;
    std::vector<Contactor> contactors_;
    std::vector<dBodyID> bodies_;  // null for planes
};

}  // namespace

OdeSolver ode_solver_for(const scenes::Scene& scene) {
    return scene.joints.empty() ? OdeSolver::quickstep : OdeSolver::step;
}

std::unique_ptr<Engine> make_ode_engine(const scenes::Scene& scene, uint32_t substeps, OdeSolver solver) {
    return std::make_unique<OdeEngine>(scene, substeps, solver);
}

}  // namespace bench
