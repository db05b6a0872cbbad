#pragma once

#include <memory>
#include <vector>

#include "hybrid_sphere/numerical_error.hpp"
#include "integration/node_queue.hpp"
#include "motion/choose_integrator.hpp"
#include "motion/equations.hpp"

namespace hybrid_sphere::numeric {

using integration::Node;

/// A lower speed, relative to the initial one of a motion, counts as rest.
inline constexpr double least_speed = 0x1p-300;

/// A solution of Equations as a continuous function of time: the accepted steps of a method are kept as
/// nodes, and the method interpolates between them. The nodes depend on the beginning and the method alone,
/// never on the requested times.
class Trajectory {
 public:
  explicit Trajectory(const scene::Solver& solver);

  /// Takes effect with the next begin().
  void set_solver(const scene::Solver& solver);

  /// @param equations  must live as long as the trajectory is used
  /// @param scale      time in which the forces change the motion, if the equations do not determine it [s]
  void begin(const Equations& equations, const State& y, double scale = never);

  /// Adds one node. Throws NumericalError if the step cannot be taken.
  void extend();

  /// The nodes that are kept, ascending in time; never empty.
  std::size_t size() const { return nodes_.size(); }
  const Node& node(std::size_t i) const { return nodes_[i]; }
  const State& last() const { return nodes_.back().y; }
  /// Number of nodes dropped since the beginning.
  std::size_t forgotten() const { return forgotten_; }

  /// Index of the last node that is not after a time, or of the first node.
  std::size_t index_at(double time) const;
  /// State at a time from that of the first node to that of the last one.
  /// @param path_velocity  set to the velocity of the path there, if it differs from the state's [m/s]
  State at(double time, Vector2d* path_velocity = nullptr);
  /// Bound on the acceleration of the path between two times up to which steps have been taken; 0 for a
  /// method without step paths [m/s^2].
  double path_bend(double from, double until) const;
  bool has_step_paths() const { return integrator_->has_step_paths(); }
  /// State at a length x after node i.
  State after(std::size_t i, double x) { return integrator_->interpolate(nodes_[i], nodes_[i + 1], x); }

  /// Drops the nodes that are not needed for times from `time` on.
  void forget_before(double time);

  /// Releases some of the memory of earlier motions, if they used much.
  void release_memory();

  double tolerance() const { return integrator_->tolerance(); }
  double negligible(double speed) const { return integrator_->negligible(speed); }
  std::uint64_t evaluations() const { return integrator_->evaluations() + evaluations_; }
  /// Sum of the estimated errors of all steps since forget_errors(), and their roundings, which are a random
  /// walk; relative to the scale of motion.
  double estimated_error() const;
  void forget_errors() {
    errors_ = 0;
    steps_ = 0;
  }

 private:
  State invert(Node& from, const Node& to, double time, double& x);
  void note_bend(Node& to) const;
  void measure(const State& y, double step);
  void make_room(Node& node);
  void keep_room(std::size_t count);

  std::unique_ptr<integration::Integrator> integrator_;
  std::unique_ptr<integration::Integrator>
      next_integrator_;  // set if another method applies from the next begin() on
  const Equations* equations_ = nullptr;
  integration::NodeQueue nodes_;
  std::vector<std::vector<State>> spare_;  // shapes without content
  std::size_t forgotten_ = 0;
  double speed_ = 0;  // scale of the velocities, lately
  State scale_ = State::Ones();
  double errors_ = 0;        // of all steps that have been taken
  std::uint64_t steps_ = 0;  // their number
  std::uint64_t evaluations_ = 0;
};

}  // namespace hybrid_sphere::numeric
