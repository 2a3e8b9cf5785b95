#include "engine.hpp"

#include <btBulletDynamicsCommon.h>

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
    Bullet(const scene::BodyTable& bodies, const Box& walls) : sphere_(btScalar(bodies.radius.front())) {
        broadphase_.m_deferedcollide = true; // all pairs in one sweep after all bodies moved: a fifth of the time less
        world_.setGravity({0, 0, 0});
        world_.getDispatchInfo().m_useContinuous = false;
        world_.getSolverInfo().m_restitutionVelocityThreshold = 0; // else slow impacts are inelastic
        add_walls(to_bullet(walls.min), to_bullet(walls.max));
        spheres_.reserve(bodies.size());
        for (std::size_t i = 0; i < bodies.size(); ++i) {
            spheres_.push_back(add(sphere_, btScalar(bodies.mass[i]), to_bullet(bodies.position[i])));
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
    /// Elastic, without friction, awake for ever; static if `mass` is 0. The product of two restitutions counts.
    btRigidBody* add(btCollisionShape& shape, btScalar mass, const btVector3& position) {
        btVector3 inertia(0, 0, 0);
        if (mass > 0) shape.calculateLocalInertia(mass, inertia);
        btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
        info.m_startWorldTransform.setOrigin(position);
        info.m_restitution = 1;
        info.m_friction = 0;
        bodies_.push_back(std::make_unique<btRigidBody>(info));
        bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
        world_.addRigidBody(bodies_.back().get());
        return bodies_.back().get();
    }

    void add_walls(const btVector3& min, const btVector3& max) {
        constexpr btScalar half_thickness = 2; // m, more than a body moves in a step
        for (int axis = 0; axis < 3; ++axis) {
            btVector3 half_sides = (max - min) / 2 + btVector3(half_thickness, half_thickness, half_thickness);
            half_sides[axis] = half_thickness;
            walls_.push_back(std::make_unique<btBoxShape>(half_sides));
            btVector3 centre = (min + max) / 2;
            for (const btScalar coordinate : {min[axis] - half_thickness, max[axis] + half_thickness}) {
                centre[axis] = coordinate;
                add(*walls_.back(), 0, centre);
            }
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

std::unique_ptr<Engine> make_engine(const scene::BodyTable& bodies, const Box& walls) {
    return std::make_unique<Bullet>(bodies, walls);
}

} // namespace carom::peers
