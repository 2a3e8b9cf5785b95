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
    explicit Ode(const scene::Scene& scene)
        : restitution_(restitution_between(scene)), slowest_bounce_(slowest_bounce(scene)) {
        const Vec3& gravity = scene.options.gravity;
        dWorldSetGravity(world_, dReal(gravity.x), dReal(gravity.y), dReal(gravity.z));
        dWorldSetAutoDisableFlag(world_, 0);
        add_walls(scene);
        spheres_.reserve(scene.bodies.size());
        for (std::size_t i = 0; i < scene.bodies.size(); ++i) add_sphere(scene.bodies, i);
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
        contact.surface.bounce = dReal(self->bounce_of(a, b));
        contact.surface.bounce_vel = dReal(self->slowest_bounce_);
        dJointAttach(dJointCreateContact(self->world_, self->contacts_, &contact), dGeomGetBody(a), dGeomGetBody(b));
    }

    /// Only walls belong to no body.
    [[nodiscard]] double bounce_of(dGeomID a, dGeomID b) const {
        if (dGeomGetBody(a) != nullptr && dGeomGetBody(b) != nullptr) return restitution_;
        const dGeomID wall = dGeomGetBody(a) == nullptr ? a : b;
        return *static_cast<const double*>(dGeomGetData(wall));
    }

    void add_walls(const scene::Scene& scene) {
        const Box& box = box_of(scene);
        const std::array<double, 3> min{box.min.x, box.min.y, box.min.z};
        const std::array<double, 3> max{box.max.x, box.max.y, box.max.z};
        for (std::size_t number = 0; number < 6; ++number) {
            const Face& face = box.faces[number];
            if (face.kind == FaceKind::open) continue;
            const std::size_t axis = number / 2;
            const bool is_upper = number % 2 == 1;
            std::array<dReal, 3> inwards{};
            inwards[axis] = is_upper ? -1 : 1;
            const double offset = is_upper ? -max[axis] : min[axis];
            const dGeomID wall = dCreatePlane(space_, inwards[0], inwards[1], inwards[2], dReal(offset));
            wall_restitutions_[number] = restitution_at(face, scene);
            dGeomSetData(wall, &wall_restitutions_[number]);
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
    double restitution_;    ///< between spheres
    double slowest_bounce_; ///< m/s
    std::array<double, 6> wall_restitutions_{};
};

} // namespace

const char* const engine_name = "ODE";
const Precision engine_precision =
    sizeof(dReal) == sizeof(float) ? Precision::single_precision : Precision::double_precision;

std::unique_ptr<Engine> make_engine(const scene::Scene& scene) { return std::make_unique<Ode>(scene); }

} // namespace carom::peers
