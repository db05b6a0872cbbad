// Open Dynamics Engine. Settings, and why:
// * dWorldStep, the pivoting solver: with one contact it is exact, and no slower than the iterative one.
// * CFM 0: the contact does not yield. ERP 0: nothing has to be pushed out, since the sphere starts a
//   millionth of its radius inside the surface layer, so that rounding never lifts it off.
// * friction: dInfinity on rough ground and 0 on smooth ground, from the place at the beginning of the
//   step.
// * no damping, no auto-disabling, no gyroscopic term (a sphere has none): only what the scene has.
// * the geometries are tested directly, without a space: the cheapest way there is to the contact.
#include <ode/ode.h>

#include "peer.hpp"
#include "rough_at.hpp"

namespace hybrid_sphere::peers {
namespace {

constexpr double layer = 1e-6;  // depth of the contact, of the radius

class OdeWorld {
 public:
  OdeWorld(const Task& task, double step) : rough_at_(task.scene.surface), step_(step) {
    const scene::SphereBody& sphere = task.scene.sphere;
    const Vector3d& gravity = task.scene.forces.gravity;
    dWorldSetGravity(world_, gravity.x(), gravity.y(), gravity.z());
    dWorldSetCFM(world_, 0);
    dWorldSetERP(world_, 0);
    dWorldSetContactSurfaceLayer(world_, layer * sphere.radius);
    dWorldSetAutoDisableFlag(world_, 0);
    dWorldSetDamping(world_, 0, 0);

    dMass mass;
    const double inertia = sphere.mass * sphere.gyration_radius * sphere.gyration_radius;
    dMassSetParameters(&mass, sphere.mass, 0, 0, 0, inertia, inertia, inertia, 0, 0, 0);
    dBodySetMass(body_, &mass);
    dBodySetGyroscopicMode(body_, 0);
    geometry_ = dCreateSphere(nullptr, sphere.radius);
    dGeomSetBody(geometry_, body_);

    const scene::InitialState& start = task.scene.initial_state;
    dBodySetPosition(body_, start.position.x(), start.position.y(), (1 - layer) * sphere.radius);
    dBodySetLinearVel(body_, start.velocity.x(), start.velocity.y(), 0);
    const Vector3d& omega = start.angular_velocity;
    dBodySetAngularVel(body_, omega.x(), omega.y(), omega.z());
  }
  OdeWorld(const OdeWorld&) = delete;
  OdeWorld& operator=(const OdeWorld&) = delete;
  ~OdeWorld() {
    dJointGroupDestroy(contacts_);
    dGeomDestroy(geometry_);
    dGeomDestroy(plane_);
    dWorldDestroy(world_);
  }

  void advance() {
    dContact contact{};
    if (dCollide(geometry_, plane_, 1, &contact.geom, sizeof(dContactGeom)) > 0) {
      const dReal* position = dBodyGetPosition(body_);
      contact.surface.mode = 0;
      contact.surface.mu = rough_at_({position[0], position[1]}) ? dInfinity : 0;
      dJointAttach(dJointCreateContact(world_, contacts_, &contact), body_, nullptr);
    }
    dWorldStep(world_, step_);
    dJointGroupEmpty(contacts_);
  }

  Sample look() const {
    const dReal* position = dBodyGetPosition(body_);
    const dReal* velocity = dBodyGetLinearVel(body_);
    const dReal* omega = dBodyGetAngularVel(body_);
    return {{position[0], position[1]}, {{velocity[0], velocity[1]}, {omega[0], omega[1], omega[2]}}};
  }

 private:
  RoughAt rough_at_;
  double step_;
  dWorldID world_ = dWorldCreate();
  dBodyID body_ = dBodyCreate(world_);
  dGeomID plane_ = dCreatePlane(nullptr, 0, 0, 1, 0);
  dGeomID geometry_ = nullptr;
  dJointGroupID contacts_ = dJointGroupCreate(0);
};

class Ode final : public Peer {
 public:
  Ode() { dInitODE2(0); }
  ~Ode() override { dCloseODE(); }

  std::string name() const override { return "ODE"; }

  Course run(const Task& task, double step) override {
    OdeWorld world(task, step);
    return march(
        task, step, [&] { world.advance(); }, [&] { return world.look(); });
  }
};

}  // namespace

std::unique_ptr<Peer> make_ode() { return std::make_unique<Ode>(); }

}  // namespace hybrid_sphere::peers
