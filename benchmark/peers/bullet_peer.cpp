// Bullet, built for double precision. Settings, and why:
// * friction 1e9 on rough ground, 0 on smooth ground, from the place at the beginning of the step. Bullet
//   cuts coefficients off at 10, which would stretch an impulse over many steps; its callback for the
//   combined coefficient goes round that.
// * two friction directions without the cone: the rows of one contact of a sphere do not couple, so that
//   one iteration is all that it takes.
// * no split impulse, ERP or slop: the sphere starts on the plane, and nothing has to be pushed out.
// * the contacts kept from earlier steps are thrown away before each: beside the one point that touches,
//   Bullet would keep points of the rolling sphere that have left the plane, with lever arms of their own.
// * no damping, no deactivation, no gyroscopic term, no restitution, no rolling friction.
// * the broadphase without a tree: there are two bodies.
#include <btBulletDynamicsCommon.h>

#include "peer.hpp"
#include "rough_at.hpp"

namespace hybrid_sphere::peers {
namespace {

constexpr double no_slip = 1e9;

btScalar product_without_limit(const btCollisionObject* a, const btCollisionObject* b) {
  return a->getFriction() * b->getFriction();
}

class BulletWorld {
 public:
  BulletWorld(const Task& task, double step) : rough_at_(task.scene.surface), step_(step) {
    const Vector3d& gravity = task.scene.forces.gravity;
    world_.setGravity({gravity.x(), gravity.y(), gravity.z()});
    configure(world_.getSolverInfo());

    plane_shape_.setMargin(0);
    plane_ = std::make_unique<btRigidBody>(0, nullptr, &plane_shape_);
    plane_->setFriction(1);
    world_.addRigidBody(plane_.get());

    const scene::SphereBody& sphere = task.scene.sphere;
    const double inertia = sphere.mass * sphere.gyration_radius * sphere.gyration_radius;
    sphere_shape_ = std::make_unique<btSphereShape>(sphere.radius);
    body_ = std::make_unique<btRigidBody>(sphere.mass, nullptr, sphere_shape_.get(),
                                          btVector3(inertia, inertia, inertia));
    place(task.scene.initial_state, sphere.radius);
    world_.addRigidBody(body_.get());
  }
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;
  ~BulletWorld() {
    world_.removeRigidBody(body_.get());
    world_.removeRigidBody(plane_.get());
  }

  void advance() {
    const btVector3& position = body_->getCenterOfMassPosition();
    body_->setFriction(rough_at_({position.x(), position.y()}) ? no_slip : 0);
    for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
      dispatcher_.getManifoldByIndexInternal(i)->clearManifold();
    }
    world_.stepSimulation(step_, 0);
  }

  Sample look() const {
    const btVector3& position = body_->getCenterOfMassPosition();
    const btVector3& velocity = body_->getLinearVelocity();
    const btVector3& omega = body_->getAngularVelocity();
    return {{position.x(), position.y()}, {{velocity.x(), velocity.y()}, {omega.x(), omega.y(), omega.z()}}};
  }

 private:
  static void configure(btContactSolverInfo& info) {
    info.m_numIterations = 1;
    info.m_solverMode =
        SOLVER_USE_WARMSTARTING | SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_DISABLE_IMPLICIT_CONE_FRICTION;
    info.m_splitImpulse = false;
    info.m_erp = 0;
    info.m_erp2 = 0;
    info.m_globalCfm = 0;
    info.m_linearSlop = 0;
    info.m_damping = 0;
    info.m_restitution = 0;
  }

  void place(const scene::InitialState& start, double radius) {
    btTransform pose;
    pose.setIdentity();
    pose.setOrigin({start.position.x(), start.position.y(), radius});
    body_->setCenterOfMassTransform(pose);
    const Vector3d& omega = start.angular_velocity;
    body_->setLinearVelocity({start.velocity.x(), start.velocity.y(), 0});
    body_->setAngularVelocity({omega.x(), omega.y(), omega.z()});
    body_->setDamping(0, 0);
    body_->setRollingFriction(0);
    body_->setSpinningFriction(0);
    body_->setFlags(0);
    body_->setActivationState(DISABLE_DEACTIVATION);
  }

  RoughAt rough_at_;
  double step_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btSimpleBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  btStaticPlaneShape plane_shape_{btVector3(0, 0, 1), 0};
  std::unique_ptr<btSphereShape> sphere_shape_;
  std::unique_ptr<btRigidBody> plane_;
  std::unique_ptr<btRigidBody> body_;
};

class Bullet final : public Peer {
 public:
  Bullet() { gCalculateCombinedFrictionCallback = product_without_limit; }

  std::string name() const override { return "Bullet"; }

  Course run(const Task& task, double step) override {
    BulletWorld world(task, step);
    return march(
        task, step, [&] { world.advance(); }, [&] { return world.look(); });
  }
};

}  // namespace

std::unique_ptr<Peer> make_bullet() { return std::make_unique<Bullet>(); }

}  // namespace hybrid_sphere::peers
