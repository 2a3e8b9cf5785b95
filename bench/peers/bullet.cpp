#include "engine.hpp"

#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <cstddef>
#include <vector>

namespace carom::peers {

namespace {

btVector3 to_bullet(const Vec3& v) { return {btScalar(v.x), btScalar(v.y), btScalar(v.z)}; }

Vec3 from_bullet(const btVector3& v) { return {double(v.x()), double(v.y()), double(v.z())}; }

/// What was tried and made it slower or changed nothing: planes for walls (every sphere is beside all of them in the
/// broad phase: twice the time), larger pools, one island for all, larger batches of islands.
class Bullet final : public Engine {
public:
    explicit Bullet(const scene::Scene& scene) : sphere_(btScalar(scene.bodies.radius.front())) {
        const scene::BodyTable& bodies = scene.bodies;
        broadphase_.m_deferedcollide = true; // all pairs in one sweep after all bodies moved: a fifth of the time less
        world_.setGravity(to_bullet(scene.options.gravity));
        world_.getDispatchInfo().m_useContinuous = false;
        world_.getSolverInfo().m_restitutionVelocityThreshold = btScalar(slowest_bounce(scene));
        // The product of two restitutions counts.
        const double restitution = std::sqrt(restitution_between(scene));
        add_walls(scene, restitution);
        spheres_.reserve(bodies.size());
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            spheres_.push_back(add(sphere_, bodies.mass[i], to_bullet(bodies.position[i]), restitution));
            spheres_.back()->setLinearVelocity(to_bullet(bodies.velocity[i]));
        }
    }

    void step(double dt) override {
        constexpr int one_step_of_dt = 0;
        world_.stepSimulation(btScalar(dt), one_step_of_dt);
    }

    void read(std::span<Vec3> positions, std::span<Vec3> velocities) const override {
        for (std::size_t i = 0; i < spheres_.size(); ++i) {
            positions[i] = from_bullet(spheres_[i]->getWorldTransform().getOrigin());
            velocities[i] = from_bullet(spheres_[i]->getLinearVelocity());
        }
    }

private:
    /// Without friction, awake for ever; static if `mass` is 0.
    btRigidBody* add(btCollisionShape& shape, double mass, const btVector3& position, double restitution) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape.calculateLocalInertia(btScalar(mass), inertia);
        btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass), nullptr, &shape, inertia);
        info.m_startWorldTransform.setOrigin(position);
        info.m_restitution = btScalar(restitution);
        info.m_friction = 0;
        bodies_.push_back(std::make_unique<btRigidBody>(info));
        bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
        world_.addRigidBody(bodies_.back().get());
        return bodies_.back().get();
    }

    void add_walls(const scene::Scene& scene, double restitution_of_spheres) {
        constexpr btScalar half_thickness = 2; // m, more than a body moves in a step
        const btVector3 min = to_bullet(box_of(scene).min);
        const btVector3 max = to_bullet(box_of(scene).max);
        for (int number = 0; number < 6; ++number) {
            const Face& face = box_of(scene).faces[std::size_t(number)];
            if (face.kind == FaceKind::open) continue;
            const int axis = number / 2;
            btVector3 half_sides = (max - min) / 2 + btVector3(half_thickness, half_thickness, half_thickness);
            half_sides[axis] = half_thickness;
            walls_.push_back(std::make_unique<btBoxShape>(half_sides));
            btVector3 centre = (min + max) / 2;
            centre[axis] = number % 2 == 0 ? min[axis] - half_thickness : max[axis] + half_thickness;
            add(*walls_.back(), 0, centre, restitution_at(face, scene) / restitution_of_spheres);
        }
    }

    // The world goes first, then the bodies, then their shapes.
    btSphereShape sphere_;
    std::vector<std::unique_ptr<btBoxShape>> walls_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<btRigidBody*> spheres_;
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDbvtBroadphase broadphase_;
    btSequentialImpulseConstraintSolver solver_;
    btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
};

} // namespace

const char* const engine_name = "Bullet";
const Precision engine_precision =
    sizeof(btScalar) == sizeof(float) ? Precision::single_precision : Precision::double_precision;

std::unique_ptr<Engine> make_engine(const scene::Scene& scene) { return std::make_unique<Bullet>(scene); }

} // namespace carom::peers
