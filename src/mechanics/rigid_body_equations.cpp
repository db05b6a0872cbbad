#include "mechanics/rigid_body_equations.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hybrid_sphere::mechanics {
namespace {

/// B of quaternion' = B w.
Eigen::Matrix<double, 4, 3> turning(const Eigen::Vector4d& quaternion) {
  Eigen::Matrix<double, 4, 3> B;
  B.row(0) = -quaternion.tail<3>().transpose() / 2;
  B.bottomRows<3>() = cross_matrix(quaternion.tail<3>()) / 2;
  B.bottomRows<3>().diagonal().array() += quaternion[0] / 2;
  return B;
}

// A torque about an axis without a moment of inertia is round-off if it is smaller than this part of the
// product of its force and arm. Arbitrary: the round-off is 1e-16 of it, a torque that is meant is of its
// size.
constexpr double max_torque_roundoff = 1e-6;

}  // namespace

const RigidBodyEquations& RigidBodyEquations::of(const Model& model) {
  const auto* const bodies = dynamic_cast<const RigidBodyEquations*>(model.equations.get());
  if (bodies == nullptr) throw std::invalid_argument("multibody system: its equations are not its own");
  return *bodies;
}

void RigidBodyEquations::evaluate(double t, const Vector& q, const Vector& v, MotionTerms& terms) const {
  momentum(t, q, v, terms.momentum, terms.mass);
  rate(q, v, terms.rate);
  terms.force.resize(velocities());
  terms.lagrangian = v.dot(terms.momentum) / 2;
  for (Index i = 0; i < count(); ++i) {
    const Body& body = bodies_[static_cast<std::size_t>(i)];
    const Index place = body_velocities * i;
    const Eigen::Vector3d weight = body.mass * gravity_;
    const Eigen::Vector3d w = v.segment<3>(place + 3);
    const Eigen::Vector3d spin = terms.momentum.segment<3>(place + 3);
    terms.lagrangian += weight.dot(q.segment<3>(body_coordinates * i));
    terms.force.segment<3>(place) = weight;
    terms.force.segment<3>(place + 3) = spin.cross(w);
    if (!body.wrenches.empty()) add_wrenches(t, q, v, i, terms.force);
  }
  add_interactions(t, q, v, terms);
  if (!(std::isfinite(terms.lagrangian) && terms.rate.allFinite() && terms.force.allFinite())) {
    throw NotFinite("rigid bodies");
  }
}

void RigidBodyEquations::add_wrenches(double t, const Vector& q, const Vector& v, Index i,
                                      Vector& force) const {
  const Body& body = bodies_[static_cast<std::size_t>(i)];
  const BodyMotion motion = BodyMotion::at(i, q, v);
  const BodyState state = state_of(motion);
  for (const WrenchFunction& function : body.wrenches) {
    const Wrench wrench = function(t, state);
    if (!(wrench.force.allFinite() && wrench.torque.allFinite())) throw NotFinite(body.label);
    add_to_body(i, motion, wrench, {body.label, motion.x.cwiseAbs().maxCoeff()}, force);
  }
}

void RigidBodyEquations::add_interactions(double t, const Vector& q, const Vector& v,
                                          MotionTerms& terms) const {
  for (const auto& interaction : interactions_) {
    Interaction::Bodies bodies;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      bodies[i] = BodyMotion::at(interaction->body(i), q, v);
      bodies[i].move();
    }
    const Wrench wrench = interaction->wrench(t, bodies);
    const double potential = interaction->potential(bodies);
    if (!(wrench.force.allFinite() && wrench.torque.allFinite() && std::isfinite(potential))) {
      throw NotFinite(interaction->label());
    }
    terms.lagrangian -= potential;
    // The same line of action for both: on the first body, the torque is about its own centre of mass.
    const Eigen::Vector3d moved = wrench.torque + (bodies[1].x - bodies[0].x).cross(wrench.force);
    const Source source{interaction->label(),
                        std::max(bodies[0].x.cwiseAbs().maxCoeff(), bodies[1].x.cwiseAbs().maxCoeff())};
    add_to_body(interaction->body(0), bodies[0], {-wrench.force, -moved}, source, terms.force);
    add_to_body(interaction->body(1), bodies[1], wrench, source, terms.force);
  }
}

void RigidBodyEquations::add_to_body(Index body, const BodyMotion& motion, const Wrench& wrench,
                                     const Source& source, Vector& force) const {
  if (body == world_body) return;
  const Body& target = bodies_[static_cast<std::size_t>(body)];
  Eigen::Vector3d torque = motion.R.transpose() * wrench.torque;
  if (target.stand_in[2] > 0) {
    const bool is_rod = target.stand_in.minCoeff() == 0;
    const Eigen::Vector3d lost = (target.stand_in.array() > 0).select(torque, 0);
    torque -= lost;
    const double arm =
        motion.x.cwiseAbs().maxCoeff() + (is_rod ? std::sqrt(target.stand_in.maxCoeff() / target.mass) : 0);
    if (lost.norm() > max_torque_roundoff * (torque.norm() + arm * wrench.force.norm())) {
      throw Undefined(source.label, source.label + " has a torque on body " + target.name +
                                        " about an axis without a moment of inertia");
    }
  }
  force.segment<3>(body_velocities * body) += wrench.force;
  force.segment<3>(body_velocities * body + 3) += torque;
}

void RigidBodyEquations::momentum(double /*t*/, const Vector& /*q*/, const Vector& v, Vector& p,
                                  Matrix& mass) const {
  mass.setZero(velocities(), velocities());
  p.resize(velocities());
  for (Index i = 0; i < count(); ++i) {
    const Body& body = bodies_[static_cast<std::size_t>(i)];
    const Index place = body_velocities * i;
    mass.diagonal().segment<3>(place).setConstant(body.mass);
    mass.block<3, 3>(place + 3, place + 3) = body.inertia;
    p.segment<3>(place) = body.mass * v.segment<3>(place);
    p.segment<3>(place + 3) = body.inertia * v.segment<3>(place + 3);
  }
  if (!p.allFinite()) throw NotFinite("rigid bodies");
}

void RigidBodyEquations::rate(const Vector& q, const Vector& v, Vector& rate) const {
  rate.resize(coordinates());
  for (Index i = 0; i < count(); ++i) {
    const Index from = body_velocities * i;
    const Index to = body_coordinates * i;
    const Eigen::Vector3d half = v.segment<3>(from + 3) / 2;
    const Eigen::Vector3d r = q.segment<3>(to + 4);
    rate.segment<3>(to) = v.segment<3>(from);
    rate[to + 3] = -r.dot(half);
    rate.segment<3>(to + 4) = q[to + 3] * half + r.cross(half);
  }
}

void RigidBodyEquations::directions(const Vector& q, const Vector& v, Matrix& directions,
                                    Vector& drift) const {
  directions.setZero(coordinates(), velocities());
  drift.setZero(coordinates());
  for (Index i = 0; i < count(); ++i) {
    const Index from = body_velocities * i;
    const Index to = body_coordinates * i;
    directions.block<3, 3>(to, from).setIdentity();
    directions.block<4, 3>(to + 3, from + 3) = turning(q.segment<4>(to + 3));
    drift.segment<4>(to + 3) = -v.segment<3>(from + 3).squaredNorm() / 4 * q.segment<4>(to + 3);
  }
}

Eigen::Isometry3d pose_of_body(Index body, const Vector& q) { return state_of(BodyMotion::at(body, q)).pose; }

BodyState state_of_body(Index body, const Vector& q, const Vector& v) {
  return state_of(BodyMotion::at(body, q, v));
}

}  // namespace hybrid_sphere::mechanics
