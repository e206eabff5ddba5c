// The same scenes in Bullet's own dynamics with its default settings: one step a frame, ten iterations. Hulls are
// btConvexHullShape as games make them, whose margin of 4 cm comes on top of the points. Friction of joints is left
// out.
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <string>
#include <vector>

#include "peer.h"

namespace bench {

namespace {

enum FilterBits : int { kOthers = 1, kChain = 2 };

btVector3 vec(taut_vec3 v) { return {v.x, v.y, v.z}; }
btVector3 vec(taut_pos p) {
    return {static_cast<btScalar>(p.x), static_cast<btScalar>(p.y), static_cast<btScalar>(p.z)};
}

// Boxes keep their true size: btBoxShape takes its margin off the inside.
std::unique_ptr<btCollisionShape> make_shape(const scenes::Shape& shape) {
    switch (shape.kind) {
        case scenes::ShapeKind::plane:
            return std::make_unique<btStaticPlaneShape>(vec(shape.normal), 0);
        case scenes::ShapeKind::box:
            return std::make_unique<btBoxShape>(vec(shape.half_extents));
        case scenes::ShapeKind::sphere:
            return std::make_unique<btSphereShape>(shape.radius);
        case scenes::ShapeKind::capsule:
            return std::make_unique<btCapsuleShape>(shape.radius, 2 * shape.half_length);
        case scenes::ShapeKind::hull: {
            auto hull = std::make_unique<btConvexHullShape>();
            for (const taut_vec3& point : shape.points) hull->addPoint(vec(point), false);
            hull->recalcLocalAabb();
            return hull;
        }
        case scenes::ShapeKind::cylinder:
        case scenes::ShapeKind::cone:
        case scenes::ShapeKind::tapered_capsule:
        case scenes::ShapeKind::scaled_hull:
        case scenes::ShapeKind::mesh:
        case scenes::ShapeKind::height_field:
            break;
    }
    throw scenes::BadScene(
        "--engine bullet does not run scenes with surfaces, cylinders or cones: Bullet's margin would change their "
        "size");
}

class BulletEngine : public Engine {
public:
    BulletEngine(const scenes::Scene& scene, uint32_t substeps)
        : substeps_(substeps), step_(scene.world.time_step / static_cast<float>(substeps)) {
        if (!scene.cables.empty())
            throw scenes::BadScene("--engine bullet: scene '" + scene.name + "' has cables, which Bullet lacks");
        dispatcher_ = std::make_unique<btCollisionDispatcher>(&configuration_);
        world_ = std::make_unique<btDiscreteDynamicsWorld>(dispatcher_.get(), &broadphase_, &solver_, &configuration_);
        world_->setGravity(vec(scene.world.gravity));
        for (const scenes::Shape& shape : scene.shapes) shapes_.push_back(make_shape(shape));
        for (const scenes::Body& body : scene.bodies) add(scene, body);
        for (const scenes::Joint& joint : scene.joints) add(joint);
    }
    ~BulletEngine() override {
        for (auto& joint : joints_) world_->removeConstraint(joint.get());
        for (auto& body : bodies_) world_->removeRigidBody(body.get());
    }

    const char* name() const override { return "bullet"; }
    const char* solver() const override { return "btSequentialImpulseConstraintSolver"; }
    uint32_t substeps() const override { return substeps_; }
    void step() override {
        for (uint32_t i = 0; i < substeps_; ++i) world_->stepSimulation(step_, 0);
    }

    Motion motion(size_t body) const override {
        const btTransform& t = bodies_[body]->getWorldTransform();
        btQuaternion q = t.getRotation();
        const btVector3 &p = t.getOrigin(), &v = bodies_[body]->getLinearVelocity(),
                        &w = bodies_[body]->getAngularVelocity();
        return {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}, {v.x(), v.y(), v.z()}, {w.x(), w.y(), w.z()}};
    }

    Mass mass(size_t body) const override {
        if (bodies_[body]->isStaticObject()) return {};
        const btVector3& inverse = bodies_[body]->getInvInertiaDiagLocal();
        return {bodies_[body]->getMass(), {1 / inverse.x(), 1 / inverse.y(), 1 / inverse.z(), 0, 0, 0}};
    }

    uint64_t state_hash() const override { return hash_of_motions(*this, bodies_.size()); }

private:
    void add(const scenes::Scene& scene, const scenes::Body& body) {
        if (body.kind == TAUT_BODY_PARTICLE)
            throw scenes::BadScene("--engine bullet: scene '" + scene.name +
                                   "' needs particles and rods, which Bullet lacks");
        btCollisionShape* shape = shapes_[static_cast<size_t>(body.shape)].get();
        btScalar mass = 0;
        btVector3 inertia(0, 0, 0);
        if (body.kind == TAUT_BODY_DYNAMIC) {
            mass = static_cast<float>(mass_of(scene, body));
            shape->calculateLocalInertia(mass, inertia);
        }
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape, inertia);
        info.m_startWorldTransform = btTransform(
            btQuaternion(body.rotation.x, body.rotation.y, body.rotation.z, body.rotation.w), vec(body.position));
        info.m_friction = std::sqrt(body.friction);  // Bullet multiplies the two; Taut takes the root of the product
        info.m_restitution = 0;
        auto rigid = std::make_unique<btRigidBody>(info);
        rigid->setLinearVelocity(vec(body.linear_velocity));
        rigid->setAngularVelocity(vec(body.angular_velocity));
        rigid->setActivationState(DISABLE_DEACTIVATION);
        int group = body.group < 0 ? kChain : kOthers;
        world_->addRigidBody(rigid.get(), group, group == kChain ? kOthers : kOthers | kChain);
        bodies_.push_back(std::move(rigid));
    }

    void add(const scenes::Joint& joint) {
        btRigidBody& b = *bodies_[static_cast<size_t>(joint.body_b)];
        std::unique_ptr<btTypedConstraint> made;
        if (joint.kind == TAUT_JOINT_BALL && joint.body_a == scenes::kWorld) {
            made = std::make_unique<btPoint2PointConstraint>(b, vec(joint.anchor_b));
        } else if (joint.body_a == scenes::kWorld) {
            throw scenes::BadScene("--engine bullet ties bodies to the world by ball joints only");
        } else {
            made = between(joint, *bodies_[static_cast<size_t>(joint.body_a)], b);
        }
        world_->addConstraint(made.get(), true);
        joints_.push_back(std::move(made));
    }

    static std::unique_ptr<btTypedConstraint> between(const scenes::Joint& joint, btRigidBody& a, btRigidBody& b) {
        if (joint.kind == TAUT_JOINT_BALL)
            return std::make_unique<btPoint2PointConstraint>(a, b, vec(joint.anchor_a), vec(joint.anchor_b));
        if (joint.kind == TAUT_JOINT_CONE_TWIST) {
            auto made = std::make_unique<btConeTwistConstraint>(a, b, frame(joint.rotation_a, joint.anchor_a),
                                                                frame(joint.rotation_b, joint.anchor_b));
            made->setLimit(joint.axes[0].upper, joint.axes[0].upper, joint.axes[1].upper);
            return made;
        }
        if (joint.kind == TAUT_JOINT_UNIVERSAL) {
            const btTransform in_a = a.getCenterOfMassTransform() * frame(joint.rotation_a, joint.anchor_a);
            const btTransform in_b = b.getCenterOfMassTransform() * frame(joint.rotation_b, joint.anchor_b);
            return std::make_unique<btUniversalConstraint>(a, b, in_a.getOrigin(), in_a.getBasis().getColumn(0),
                                                           in_b.getBasis().getColumn(1));
        }
        if (joint.kind != TAUT_JOINT_HINGE)
            throw scenes::BadScene("--engine bullet runs ball, universal, hinge and cone-twist joints only");
        // A hinge turns about z here, about x there.
        const btTransform z_to_x(btQuaternion(btVector3(0, 1, 0), SIMD_HALF_PI));
        auto made = std::make_unique<btHingeConstraint>(a, b, frame(joint.rotation_a, joint.anchor_a) * z_to_x,
                                                        frame(joint.rotation_b, joint.anchor_b) * z_to_x);
        if (!joint.axes.empty()) made->setLimit(joint.axes[0].lower, joint.axes[0].upper);
        return made;
    }

    static btTransform frame(taut_quat q, taut_pos p) { return btTransform(btQuaternion(q.x, q.y, q.z, q.w), vec(p)); }

    uint32_t substeps_;
    btScalar step_;
    btDefaultCollisionConfiguration configuration_;
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    std::unique_ptr<btCollisionDispatcher> dispatcher_;
    std::unique_ptr<btDiscreteDynamicsWorld> world_;
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<btTypedConstraint>> joints_;
};

}  // namespace

std::unique_ptr<Engine> make_bullet_engine(const scenes::Scene& scene, uint32_t substeps) {
    return std::make_unique<BulletEngine>(scene, substeps);
}

}  // namespace bench
