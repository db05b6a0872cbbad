#pragma once

#include <memory>
#include <vector>

#include "hybrid_sphere/numerical_error.hpp"
#include "integration/node_queue.hpp"
#include "motion/choose_integrator.hpp"
#include "motion/equations.hpp"

namespace hybrid_sphere::numeric {

using integration::Node;

/// What is slower, in units of what a motion began with, is not told from rest.
inline constexpr double least_speed = 0x1p-300;

/// A solution of Equations as a continuous function of the time: the accepted steps of a method are kept as
/// nodes, and the method says what lies between them. The nodes depend on the beginning and the method alone,
/// never on the times that are asked for.
class Trajectory {
 public:
  explicit Trajectory(const scene::Solver& solver);

  /// From the next begin() on.
  void set_solver(const scene::Solver& solver);

  /// @param equations  have to live as long as the trajectory is used
  /// @param scale      time in which the forces change the motion, where the equations do not tell [s]
  void begin(const Equations& equations, const State& y, double scale = never);

  /// Adds one node. Throws NumericalError if the step cannot be taken.
  void extend();

  /// The nodes that are kept, ascending in time; never empty.
  std::size_t size() const { return nodes_.size(); }
  const Node& node(std::size_t i) const { return nodes_[i]; }
  const State& last() const { return nodes_.back().y; }
  /// Number of nodes that have been let go since the beginning.
  std::size_t forgotten() const { return forgotten_; }

  /// Of the last node that is not after a time, or of the first one.
  std::size_t index_at(double time) const;
  /// State at a time from that of the first node to that of the last one.
  /// @param path_velocity  becomes that of the way there, if it is another one than the state's [m/s]
  State at(double time, Vector2d* path_velocity = nullptr);
  /// Bound on the acceleration of the way between two times in which steps have been taken, 0 of a method
  /// without step paths [m/s^2].
  double path_bend(double from, double until) const;
  bool has_step_paths() const { return integrator_->has_step_paths(); }
  /// State a length x after node i.
  State after(std::size_t i, double x) { return integrator_->interpolate(nodes_[i], nodes_[i + 1], x); }

  /// Lets the nodes go that no time from `time` on needs.
  void forget_before(double time);

  /// Gives back some of the memory of motions before this one, if they took much.
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
      next_integrator_;  // where it is another one from the next begin() on
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
