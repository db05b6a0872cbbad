// DART. Settings, and why:
// * Dantzig's solver, exact for one contact; the least constraint force mixing that DART takes.
// * no error reduction: the sphere starts 1e-10 of its radius deep, so that rounding never lifts it off;
//   the lever arm is shorter by as much.
// * friction 1e6 on rough ground, which no reaction here comes near, and 0 on smooth ground, from the place
//   at the beginning of the step.
// * DART's own collision detector, which is the cheapest for a sphere on a box; no damping, no sleeping.
#include <dart/collision/dart/DARTCollisionDetector.hpp>
#include <dart/constraint/BoxedLcpConstraintSolver.hpp>
#include <dart/constraint/ContactConstraint.hpp>
#include <dart/constraint/DantzigBoxedLcpSolver.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/BoxShape.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/dynamics/SphereShape.hpp>
#include <dart/dynamics/WeldJoint.hpp>
#include <dart/simulation/World.hpp>

#include <tuple>

#include "peer.hpp"
#include "rough_at.hpp"

namespace hybrid_sphere::peers {
namespace {

using dart::constraint::ContactConstraint;
using dart::dynamics::FreeJoint;
using dart::dynamics::Skeleton;
using dart::dynamics::WeldJoint;

constexpr double depth = 1e-10;  // of the contact, of the radius
constexpr double no_slip = 1e6;
constexpr double extent = 1e5;  // of the ground [m]

dart::dynamics::SkeletonPtr make_ground(double thickness) {
  const auto ground = Skeleton::create("ground");
  const auto [joint, body] = ground->createJointAndBodyNodePair<WeldJoint>();
  const auto box = std::make_shared<dart::dynamics::BoxShape>(Vector3d(extent, extent, thickness));
  auto* shape =
      body->createShapeNodeWith<dart::dynamics::CollisionAspect, dart::dynamics::DynamicsAspect>(box);
  shape->getDynamicsAspect()->setFrictionCoeff(no_slip);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().z() = -0.5 * thickness;
  joint->setTransformFromParentBodyNode(pose);
  return ground;
}

class DartWorld {
 public:
  DartWorld(const Task& task, double step) : rough_at_(task.scene.surface) {
    add_body(task.scene.sphere);
    place(task.scene.initial_state, task.scene.sphere.radius);
    world_->setTimeStep(step);
    world_->setGravity(task.scene.forces.gravity);
    world_->addSkeleton(make_ground(10 * task.scene.sphere.radius));
    world_->addSkeleton(skeleton_);
    auto solver = std::make_unique<dart::constraint::BoxedLcpConstraintSolver>(
        std::make_shared<dart::constraint::DantzigBoxedLcpSolver>());
    solver->setCollisionDetector(dart::collision::DARTCollisionDetector::create());
    world_->setConstraintSolver(std::move(solver));
  }

  void advance() {
    const Vector3d position = body_->getWorldTransform().translation();
    surface_->setFrictionCoeff(rough_at_(position.head<2>()) ? no_slip : 0);
    world_->step();
  }

  Sample look() const {
    const Vector3d position = body_->getWorldTransform().translation();
    return {position.head<2>(), {body_->getLinearVelocity().head<2>(), body_->getAngularVelocity()}};
  }

 private:
  void add_body(const scene::SphereBody& sphere) {
    const double inertia = sphere.mass * sphere.gyration_radius * sphere.gyration_radius;
    std::tie(joint_, body_) = skeleton_->createJointAndBodyNodePair<FreeJoint>();
    body_->setInertia(
        dart::dynamics::Inertia(sphere.mass, Vector3d::Zero(), inertia * Eigen::Matrix3d::Identity()));
    const auto ball = std::make_shared<dart::dynamics::SphereShape>(sphere.radius);
    surface_ =
        body_->createShapeNodeWith<dart::dynamics::CollisionAspect, dart::dynamics::DynamicsAspect>(ball)
            ->getDynamicsAspect();
  }

  void place(const scene::InitialState& start, double radius) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() = Vector3d(start.position.x(), start.position.y(), (1 - depth) * radius);
    joint_->setTransform(pose);
    joint_->setLinearVelocity(Vector3d(start.velocity.x(), start.velocity.y(), 0));
    joint_->setAngularVelocity(start.angular_velocity);
  }

  RoughAt rough_at_;
  dart::simulation::WorldPtr world_ = dart::simulation::World::create();
  dart::dynamics::SkeletonPtr skeleton_ = Skeleton::create("sphere");
  FreeJoint* joint_ = nullptr;
  dart::dynamics::BodyNode* body_ = nullptr;
  dart::dynamics::DynamicsAspect* surface_ = nullptr;
};

class Dart final : public Peer {
 public:
  Dart() {
    ContactConstraint::setErrorReductionParameter(0);
    ContactConstraint::setErrorAllowance(0);
    ContactConstraint::setConstraintForceMixing(1e-9);
  }

  std::string name() const override { return "DART"; }

  Course run(const Task& task, double step) override {
    DartWorld world(task, step);
    return march(
        task, step, [&] { world.advance(); }, [&] { return world.look(); });
  }
};

}  // namespace

std::unique_ptr<Peer> make_dart() { return std::make_unique<Dart>(); }

}  // namespace hybrid_sphere::peers
