// Siconos. Settings, and why:
// * the sphere as a linear system with six velocities, v and omega on the fixed axes, which it is as long as
//   nothing depends on its orientation; the contact's velocities are linear in them. As a rigid body with a
//   quaternion (NewtonEulerDS) it is of first order wherever omega changes, since its omega is on the axes
//   of the body. The orientation is lost thereby.
// * Moreau and Jean's time stepping with theta = 1/2: impulses are part of a step, and parabolas come out
//   exactly.
// * Newton's impact law, restitution 0, with Coulomb friction: 1e7 on rough ground, which no reaction here
//   comes near, and 0 on smooth ground, from the place at the beginning of the step.
// * nonsmooth Gauss and Seidel, which with one contact is Newton's method for it, to a tolerance of 1e-14.
// * the sphere starts 1e-10 of its radius deep, so that rounding never lifts it off.
#include <SolverOptions.h>

#include <SiconosKernel.hpp>

#include "peer.hpp"
#include "rough_at.hpp"

namespace hybrid_sphere::peers {
namespace {

constexpr double depth = 1e-10;  // of the contact, of the radius
constexpr double no_slip = 1e7;

SP::SiconosVector vector_of(std::initializer_list<double> values) {
  auto vector = std::make_shared<SiconosVector>(static_cast<unsigned>(values.size()));
  unsigned i = 0;
  for (const double value : values) vector->setValue(i++, value);
  return vector;
}

/// q' = (v, omega): the last three coordinates have no meaning.
std::shared_ptr<LagrangianLinearTIDS> make_sphere(const Task& task) {
  const scene::SphereBody& sphere = task.scene.sphere;
  const scene::InitialState& start = task.scene.initial_state;
  const Vector3d& omega = start.angular_velocity;
  const double inertia = sphere.mass * sphere.gyration_radius * sphere.gyration_radius;
  auto mass = std::make_shared<SimpleMatrix>(6, 6);
  for (unsigned i = 0; i < 6; ++i) mass->setValue(i, i, i < 3 ? sphere.mass : inertia);
  auto body = std::make_shared<LagrangianLinearTIDS>(
      vector_of({start.position.x(), start.position.y(), (1 - depth) * sphere.radius, 0, 0, 0}),
      vector_of({start.velocity.x(), start.velocity.y(), 0, omega[0], omega[1], omega[2]}), mass);
  const Vector3d weight = sphere.mass * task.scene.forces.gravity;
  body->setFExtPtr(vector_of({weight[0], weight[1], weight[2], 0, 0, 0}));
  return body;
}

/// The height of the lowest point, and its velocities (zd, xd - R omega_2, yd + R omega_1).
std::shared_ptr<LagrangianLinearTIR> make_contact(double radius) {
  auto velocities = std::make_shared<SimpleMatrix>(3, 6);
  velocities->setValue(0, 2, 1);
  velocities->setValue(1, 0, 1);
  velocities->setValue(1, 4, -radius);
  velocities->setValue(2, 1, 1);
  velocities->setValue(2, 3, radius);
  return std::make_shared<LagrangianLinearTIR>(velocities, vector_of({-radius, 0, 0}));
}

class SiconosWorld {
 public:
  SiconosWorld(const Task& task, double step) : rough_at_(task.scene.surface), sphere_(make_sphere(task)) {
    auto model = std::make_shared<NonSmoothDynamicalSystem>(0, 2 * task.duration() + step);
    model->insertDynamicalSystem(sphere_);
    model->link(std::make_shared<Interaction>(law_, make_contact(task.scene.sphere.radius)), sphere_);

    contact_ = std::make_shared<FrictionContact>(3, SICONOS_FRICTION_3D_NSGS);
    contact_->numericsSolverOptions()->dparam[SICONOS_DPARAM_TOL] = 1e-14;
    contact_->setNumericsVerboseMode(false);
    simulation_ = std::make_shared<TimeStepping>(model, std::make_shared<TimeDiscretisation>(0, step),
                                                 std::make_shared<MoreauJeanOSI>(0.5), contact_);
    simulation_->setNewtonOptions(SICONOS_TS_LINEAR);
    simulation_->setWarnOnNonConvergence(false);
  }

  void advance() {
    law_->setMu(rough_at_({sphere_->q()->getValue(0), sphere_->q()->getValue(1)}) ? no_slip : 0);
    simulation_->computeOneStep();
    simulation_->nextStep();
  }

  Sample look() const {
    const auto q = [&](unsigned i) { return sphere_->q()->getValue(i); };
    const auto v = [&](unsigned i) { return sphere_->velocity()->getValue(i); };
    return {{q(0), q(1)}, {{v(0), v(1)}, {v(3), v(4), v(5)}}};
  }

 private:
  RoughAt rough_at_;
  std::shared_ptr<LagrangianLinearTIDS> sphere_;
  std::shared_ptr<NewtonImpactFrictionNSL> law_ = std::make_shared<NewtonImpactFrictionNSL>(0, 0, no_slip, 3);
  std::shared_ptr<FrictionContact> contact_;
  std::shared_ptr<TimeStepping> simulation_;
};

class Siconos final : public Peer {
 public:
  std::string name() const override { return "Siconos"; }

  Course run(const Task& task, double step) override {
    SiconosWorld world(task, step);
    Course course = march(
        task, step, [&] { world.advance(); }, [&] { return world.look(); });
    course.note = "without orientation";
    return course;
  }
};

}  // namespace

std::unique_ptr<Peer> make_siconos() { return std::make_unique<Siconos>(); }

}  // namespace hybrid_sphere::peers
