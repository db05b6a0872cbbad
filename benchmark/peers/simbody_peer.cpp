// Simbody. It can do what the others cannot: place events where a function of the state changes its sign,
// and impose the constraint of rolling itself. So its best is:
// * Constraint::SphereOnPlaneContact, with rolling on rough ground and without it on smooth ground,
//   exchanged by an event handler on every line that bears an edge of a region; the impulse is that of
//   Simbody's own operators, G and the inverse of M, on the slip.
// * the integrator by Runge, Kutta and Merson, whose steps follow the accuracy that is asked for: the dial
//   is that accuracy, the window in which events are placed being much narrower.
// * no forces but gravity; no friction is left to a coefficient.
#include <Simbody.h>

#include <stdexcept>

#include "peer.hpp"
#include "rough_at.hpp"

namespace hybrid_sphere::peers {
namespace {

using SimTK::Real;
using SimTK::Stage;
using SimTK::State;
using SimTK::Vec3;
using SimTK::Vector;

constexpr double ahead =
    1e-9;  // how far an event's handler looks for the new ground: events lie within rounding [s]

/// The sphere on its plane, with two constraints of which one is in force.
class SimbodySphere {
 public:
  explicit SimbodySphere(const Task& task) : rough_at_(task.scene.surface) {
    const scene::SphereBody& sphere = task.scene.sphere;
    const Vector3d& gravity = task.scene.forces.gravity;
    const Real inertia = sphere.mass * sphere.gyration_radius * sphere.gyration_radius;
    gravity_ = SimTK::Force::UniformGravity(forces_, matter_, Vec3(gravity.x(), gravity.y(), gravity.z()));
    const SimTK::Body::Rigid rigid(SimTK::MassProperties(sphere.mass, Vec3(0), SimTK::Inertia(inertia)));
    body_ = SimTK::MobilizedBody::Free(matter_.updGround(), SimTK::Transform(), rigid, SimTK::Transform());
    const auto contact = [&](bool rolls) {
      SimTK::Constraint::SphereOnPlaneContact constraint(matter_.updGround(), SimTK::Transform(), body_,
                                                         Vec3(0), sphere.radius, rolls);
      constraint.setDisabledByDefault(true);
      return constraint;
    };
    slides_ = contact(false);
    rolls_ = contact(true);
  }

  SimTK::MultibodySystem& system() { return system_; }

  State start(const Task& task) {
    State state = system_.realizeTopology();
    const scene::InitialState& initial = task.scene.initial_state;
    const Vector3d& omega = initial.angular_velocity;
    body_.setQToFitTranslation(state,
                               Vec3(initial.position.x(), initial.position.y(), task.scene.sphere.radius));
    body_.setUToFitAngularVelocity(state, Vec3(omega[0], omega[1], omega[2]));
    body_.setUToFitLinearVelocity(state, Vec3(initial.velocity.x(), initial.velocity.y(), 0));
    impose(state);
    return state;
  }

  /// The constraint of the ground under the sphere comes into force, with its impulse.
  void impose(State& state) const {
    const Vector2d velocity = look(state).twist.velocity;
    const bool rolls = rough_at_(position(state) + ahead * velocity);
    if (!rolls_.isDisabled(state) == rolls && !slides_.isDisabled(state) == !rolls) return;
    (rolls ? rolls_ : slides_).enable(state);
    (rolls ? slides_ : rolls_).disable(state);
    system_.realize(state, Stage::Velocity);
    const Vector wanted = -state.getUErr();
    Vector impulse, momentum, change;
    matter_.solveForConstraintImpulses(state, wanted, impulse);
    matter_.multiplyByGTranspose(state, impulse, momentum);
    matter_.multiplyByMInv(state, momentum, change);
    state.updU() += change;
    system_.realize(state, Stage::Velocity);
  }

  Vector2d position(const State& state) const {
    const Vec3 p = body_.getBodyOriginLocation(state);
    return {p[0], p[1]};
  }

  Sample look(const State& state) const {
    system_.realize(state, Stage::Velocity);
    const Vec3 v = body_.getBodyOriginVelocity(state);
    const Vec3 w = body_.getBodyAngularVelocity(state);
    return {position(state), {{v[0], v[1]}, {w[0], w[1], w[2]}}};
  }

 private:
  RoughAt rough_at_;
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_{system_};
  SimTK::GeneralForceSubsystem forces_{system_};
  SimTK::Force::UniformGravity gravity_;
  SimTK::MobilizedBody::Free body_;
  SimTK::Constraint::SphereOnPlaneContact slides_;
  SimTK::Constraint::SphereOnPlaneContact rolls_;
};

/// Looks for the instant at which the sphere is over a line.
class LineHandler final : public SimTK::TriggeredEventHandler {
 public:
  LineHandler(const SimbodySphere& sphere, const Vector2d& point, const Vector2d& normal)
      : TriggeredEventHandler(Stage::Position), sphere_(sphere), point_(point), normal_(normal.normalized()) {
    getTriggerInfo().setRequiredLocalizationTimeWindow(1e-6);  // of the accuracy and the scale of time
  }

  Real getValue(const State& state) const override { return normal_.dot(sphere_.position(state) - point_); }

  void handleEvent(State& state, Real /*accuracy*/, bool& /*terminate*/) const override {
    sphere_.impose(state);
  }

 private:
  const SimbodySphere& sphere_;
  Vector2d point_;
  Vector2d normal_;
};

void add_handlers(SimbodySphere& sphere, const scene::Shape& shape) {
  SimTK::MultibodySystem& system = sphere.system();
  if (const auto* half = std::get_if<scene::HalfPlane>(&shape)) {
    system.addEventHandler(new LineHandler(sphere, half->point, half->normal));
  } else if (const auto* polygon = std::get_if<scene::Polygon>(&shape)) {
    for (std::size_t i = 0; i < polygon->vertices.size(); ++i) {
      const Vector2d& a = polygon->vertices[i];
      const Vector2d side = polygon->vertices[(i + 1) % polygon->vertices.size()] - a;
      system.addEventHandler(new LineHandler(sphere, a, {-side.y(), side.x()}));
    }
  } else {
    throw std::invalid_argument("only half-planes and polygons have handlers here");
  }
}

class Simbody final : public Peer {
 public:
  std::string name() const override { return "Simbody"; }
  std::vector<double> dials() const override { return {1e-1, 1e-3, 1e-6, 1e-9, 1e-12}; }
  bool chooses_steps() const override { return true; }

  Course run(const Task& task, double accuracy) override {
    SimbodySphere sphere(task);
    for (const scene::Region& region : task.scene.surface.regions) add_handlers(sphere, region.shape);
    const State start = sphere.start(task);
    SimTK::RungeKuttaMersonIntegrator integrator(sphere.system());
    integrator.setAccuracy(accuracy);
    SimTK::TimeStepper stepper(sphere.system(), integrator);
    stepper.initialize(start);
    int outputs = 0;
    Course course = march(
        task, task.interval, [&] { stepper.stepTo(task.interval * ++outputs); },
        [&] { return sphere.look(stepper.getState()); });
    course.note = "step is the accuracy asked for";
    return course;
  }
};

}  // namespace

std::unique_ptr<Peer> make_simbody() { return std::make_unique<Simbody>(); }

}  // namespace hybrid_sphere::peers
