// The same scenes in Bullet's own dynamics with its default settings: one step a frame, ten iterations. Hulls are
// btConvexHullShape as games make them, whose margin of 4 cm comes on top of the points. Friction of joints is left
// out. Cloths are its soft bodies of links in btSoftRigidDynamicsWorld, as stiff as they go (kLST 1), with twenty
// iterations of positions, and touch rigid shapes by their vertices at 5 mm; weights on vertices are added to theirs.
// Solids are the same along the edges of their tetrahedra: its stiffness has no unit, and Young's modulus goes unused.
#include <BulletSoftBody/btSoftBody.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "peer.h"
#include "soft_metrics.h"

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
        make_world(scene);
        world_->setGravity(vec(scene.world.gravity));
        for (const scenes::Cloth& cloth : scene.cloths) add(cloth);
        for (const scenes::Solid& solid : scene.solids) add(solid);
        for (const scenes::Shape& shape : scene.shapes) shapes_.push_back(make_shape(shape));
        for (const scenes::Body& body : scene.bodies)
            if (!load(scene, body)) add(scene, body);
        for (const scenes::Joint& joint : scene.joints)
            if (joint.vertex_b.cloth < 0) add(joint);
    }
    ~BulletEngine() override {
        for (auto& joint : joints_) world_->removeConstraint(joint.get());
        for (auto& body : bodies_)
            if (body) world_->removeRigidBody(body.get());
        for (auto& cloth : cloths_) soft_world_->removeSoftBody(cloth.get());
        for (auto& solid : solids_) soft_world_->removeSoftBody(solid.get());
    }

    const char* name() const override { return "bullet"; }
    const char* solver() const override { return "btSequentialImpulseConstraintSolver"; }
    uint32_t substeps() const override { return substeps_; }
    void step() override {
        for (uint32_t i = 0; i < substeps_; ++i) world_->stepSimulation(step_, 0);
    }

    Motion motion(size_t body) const override {
        if (const btSoftBody::Node* node = carrier(body))
            return {{node->m_x.x(), node->m_x.y(), node->m_x.z()},
                    {0, 0, 0, 1},
                    {node->m_v.x(), node->m_v.y(), node->m_v.z()},
                    {}};
        const btTransform& t = bodies_[body]->getWorldTransform();
        btQuaternion q = t.getRotation();
        const btVector3 &p = t.getOrigin(), &v = bodies_[body]->getLinearVelocity(),
                        &w = bodies_[body]->getAngularVelocity();
        return {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}, {v.x(), v.y(), v.z()}, {w.x(), w.y(), w.z()}};
    }

    Mass mass(size_t body) const override {
        if (carrier(body)) return {weights_[body].mass, {}};
        if (bodies_[body]->isStaticObject()) return {};
        const btVector3& inverse = bodies_[body]->getInvInertiaDiagLocal();
        return {bodies_[body]->getMass(), {1 / inverse.x(), 1 / inverse.y(), 1 / inverse.z(), 0, 0, 0}};
    }

    void read_cloth(size_t index, SoftState& state) const override { read(*cloths_[index], state); }
    void read_solid(size_t index, SoftState& state) const override { read(*solids_[index], state); }

    uint64_t state_hash() const override {
        uint64_t hash = hash_of_motions(*this, bodies_.size());
        const auto add = [&](const btSoftBody& soft) {
            for (int i = 0; i < soft.m_nodes.size(); ++i)
                for (int axis = 0; axis < 3; ++axis) {
                    const float value = soft.m_nodes[i].m_x[axis];
                    uint32_t bits = 0;
                    std::memcpy(&bits, &value, sizeof bits);
                    hash = (hash ^ bits) * 0x100000001b3u;
                }
        };
        for (const auto& cloth : cloths_) add(*cloth);
        for (const auto& solid : solids_) add(*solid);
        return hash;
    }

private:
    // A point mass that a joint puts on a vertex.
    struct Weight {
        int cloth = -1;
        uint32_t vertex = 0;
        double mass = 0;
    };

    void make_world(const scenes::Scene& scene) {
        const bool rigid = scene.cloths.empty() && scene.solids.empty();
        configuration_ = rigid ? std::make_unique<btDefaultCollisionConfiguration>()
                               : std::make_unique<btSoftBodyRigidBodyCollisionConfiguration>();
        dispatcher_ = std::make_unique<btCollisionDispatcher>(configuration_.get());
        if (rigid) {
            world_ = std::make_unique<btDiscreteDynamicsWorld>(dispatcher_.get(), &broadphase_, &solver_,
                                                               configuration_.get());
            return;
        }
        auto soft =
            std::make_unique<btSoftRigidDynamicsWorld>(dispatcher_.get(), &broadphase_, &solver_, configuration_.get());
        soft_world_ = soft.get();
        world_ = std::move(soft);
        btSoftBodyWorldInfo& info = soft_world_->getWorldInfo();
        info.m_dispatcher = dispatcher_.get();
        info.m_broadphase = &broadphase_;
        info.m_gravity = vec(scene.world.gravity);
        info.air_density = info.water_density = 0;
        info.m_sparsesdf.Initialize();
        weights_.resize(scene.bodies.size());
        for (const scenes::Joint& joint : scene.joints)
            if (joint.vertex_b.cloth >= 0 && joint.body_a >= 0) {
                const auto body = static_cast<size_t>(joint.body_a);
                weights_[body] = {joint.vertex_b.cloth, joint.vertex_b.vertex, mass_of(scene, scene.bodies[body])};
            }
    }

    static void read(const btSoftBody& soft, SoftState& state) {
        const auto count = static_cast<size_t>(soft.m_nodes.size());
        state.points.resize(count);
        state.velocities.resize(count);
        for (int i = 0; i < soft.m_nodes.size(); ++i) {
            const btVector3 &x = soft.m_nodes[i].m_x, &v = soft.m_nodes[i].m_v;
            state.points[static_cast<size_t>(i)] = {x.x(), x.y(), x.z()};
            state.velocities[static_cast<size_t>(i)] = {v.x(), v.y(), v.z()};
        }
    }

    void add(const scenes::Cloth& cloth) {
        const SoftShape shape(cloth);
        auto body = made(cloth.points, shape, shape.sides, cloth.def.material.friction);
        if (cloth.def.filter.mask == 0) body->m_cfg.collisions = 0;
        soft_world_->addSoftBody(body.get());
        cloths_.push_back(std::move(body));
    }

    void add(const scenes::Solid& solid) {
        const SoftShape shape(solid);
        std::set<std::array<uint32_t, 2>> edges;
        for (const auto& tet : shape.tets)
            for (size_t a = 0; a < 4; ++a)
                for (size_t b = a + 1; b < 4; ++b) edges.insert({std::min(tet[a], tet[b]), std::max(tet[a], tet[b])});
        auto body = made(solid.points, shape, {edges.begin(), edges.end()}, solid.def.surface.friction);
        if (solid.def.filter.mask == 0) body->m_cfg.collisions = 0;
        soft_world_->addSoftBody(body.get());
        solids_.push_back(std::move(body));
    }

    std::unique_ptr<btSoftBody> made(const std::vector<taut_pos>& at, const SoftShape& shape,
                                     const std::vector<std::array<uint32_t, 2>>& links, float friction) {
        constexpr int kIterations = 20;
        constexpr float kThickness = 0.005f;
        std::vector<btVector3> points;
        std::vector<btScalar> mass;
        for (const taut_pos& p : at) points.push_back(vec(p));
        for (const double m : shape.mass) mass.push_back(static_cast<btScalar>(m));
        auto body = std::make_unique<btSoftBody>(&soft_world_->getWorldInfo(), static_cast<int>(points.size()),
                                                 points.data(), mass.data());
        body->m_materials[0]->m_kLST = 1;
        for (const auto& [a, b] : links) body->appendLink(static_cast<int>(a), static_cast<int>(b));
        for (const auto& f : shape.faces)
            body->appendFace(static_cast<int>(f[0]), static_cast<int>(f[1]), static_cast<int>(f[2]));
        body->m_cfg.piterations = kIterations;
        body->m_cfg.kDF = friction;
        body->m_cfg.kDP = 0;
        body->getCollisionShape()->setMargin(kThickness);
        return body;
    }

    // Whether the body is a weight on a vertex; it is added to that.
    bool load(const scenes::Scene& scene, const scenes::Body& body) {
        const size_t index = bodies_.size();
        if (index >= weights_.size() || weights_[index].cloth < 0) return false;
        const Weight& weight = weights_[index];
        btSoftBody& cloth = *cloths_[static_cast<size_t>(weight.cloth)];
        const auto node = static_cast<int>(weight.vertex);
        cloth.setMass(node, cloth.getMass(node) + static_cast<btScalar>(mass_of(scene, body)));
        bodies_.push_back(nullptr);
        return true;
    }

    const btSoftBody::Node* carrier(size_t body) const {
        if (body >= weights_.size() || weights_[body].cloth < 0) return nullptr;
        return &cloths_[static_cast<size_t>(weights_[body].cloth)]->m_nodes[static_cast<int>(weights_[body].vertex)];
    }

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
    std::unique_ptr<btDefaultCollisionConfiguration> configuration_;
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    std::unique_ptr<btCollisionDispatcher> dispatcher_;
    std::unique_ptr<btDiscreteDynamicsWorld> world_;
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<btTypedConstraint>> joints_;
    btSoftRigidDynamicsWorld* soft_world_ = nullptr;  // world_, in scenes with cloths or solids
    std::vector<std::unique_ptr<btSoftBody>> cloths_, solids_;
    std::vector<Weight> weights_;  // by body, in scenes with cloths
};

}  // namespace

std::unique_ptr<Engine> make_bullet_engine(const scenes::Scene& scene, uint32_t substeps) {
    return std::make_unique<BulletEngine>(scene, substeps);
}

}  // namespace bench
