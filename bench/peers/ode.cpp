#include "engine.hpp"

#include <ode/ode.h>

#include <array>
#include <cstddef>
#include <vector>

namespace carom::peers {

namespace {

/// What ODE needs before all else, and after it.
class Library {
public:
    Library() { dInitODE(); }
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;
    ~Library() { dCloseODE(); }
};

/// Sweep and prune is the space that suits all sizes: a hash space is a tenth faster with 10 000 bodies, and slower
/// with fewer and with more.
class Ode final : public Engine {
public:
    Ode(const scene::BodyTable& bodies, const Box& walls) {
        dWorldSetAutoDisableFlag(world_, 0);
        add_walls(walls);
        spheres_.reserve(bodies.size());
        for (std::size_t i = 0; i < bodies.size(); ++i) add_sphere(bodies, i);
    }
    Ode(const Ode&) = delete;
    Ode& operator=(const Ode&) = delete;
    ~Ode() override {
        dJointGroupDestroy(contacts_);
        dSpaceDestroy(space_);
        dWorldDestroy(world_);
    }

    void step(double dt) override {
        dSpaceCollide(space_, this, &add_contact);
        dWorldQuickStep(world_, dReal(dt));
        dJointGroupEmpty(contacts_);
    }

    void read(std::span<Vec3> positions, std::span<Vec3> velocities) const override {
        for (std::size_t i = 0; i < spheres_.size(); ++i) {
            const dReal* position = dBodyGetPosition(spheres_[i]);
            const dReal* velocity = dBodyGetLinearVel(spheres_[i]);
            positions[i] = {position[0], position[1], position[2]};
            velocities[i] = {velocity[0], velocity[1], velocity[2]};
        }
    }

private:
    static void add_contact(void* engine, dGeomID a, dGeomID b) {
        const auto* self = static_cast<const Ode*>(engine);
        dContact contact{};
        if (dCollide(a, b, 1, &contact.geom, sizeof contact) == 0) return;
        contact.surface.mode = dContactBounce;
        contact.surface.bounce = 1;
        contact.surface.bounce_vel = 0;
        dJointAttach(dJointCreateContact(self->world_, self->contacts_, &contact), dGeomGetBody(a), dGeomGetBody(b));
    }

    void add_walls(const Box& walls) {
        const std::array<double, 3> min{walls.min.x, walls.min.y, walls.min.z};
        const std::array<double, 3> max{walls.max.x, walls.max.y, walls.max.z};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::array<dReal, 3> inwards{};
            inwards[axis] = 1;
            dCreatePlane(space_, inwards[0], inwards[1], inwards[2], dReal(min[axis]));
            inwards[axis] = -1;
            dCreatePlane(space_, inwards[0], inwards[1], inwards[2], dReal(-max[axis]));
        }
    }

    void add_sphere(const scene::BodyTable& bodies, std::size_t i) {
        const Vec3& position = bodies.position[i];
        const Vec3& velocity = bodies.velocity[i];
        dMass mass;
        dMassSetSphereTotal(&mass, dReal(bodies.mass[i]), dReal(bodies.radius[i]));
        const dBodyID body = dBodyCreate(world_);
        dBodySetMass(body, &mass);
        dBodySetGyroscopicMode(body, 0); // a sphere has no such torque
        dGeomSetBody(dCreateSphere(space_, dReal(bodies.radius[i])), body);
        dBodySetPosition(body, dReal(position.x), dReal(position.y), dReal(position.z));
        dBodySetLinearVel(body, dReal(velocity.x), dReal(velocity.y), dReal(velocity.z));
        spheres_.push_back(body);
    }

    Library library_;
    dWorldID world_ = dWorldCreate();
    dSpaceID space_ = dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ);
    dJointGroupID contacts_ = dJointGroupCreate(0);
    std::vector<dBodyID> spheres_;
};

} // namespace

const char* const engine_name = "ODE";
const Precision engine_precision =
    sizeof(dReal) == sizeof(float) ? Precision::single_precision : Precision::double_precision;

std::unique_ptr<Engine> make_engine(const scene::BodyTable& bodies, const Box& walls) {
    return std::make_unique<Ode>(bodies, walls);
}

} // namespace carom::peers
