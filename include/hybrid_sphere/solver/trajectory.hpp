#pragma once

#include <vector>

#include "hybrid_sphere/integration/runge_kutta.hpp"
#include "hybrid_sphere/solver/stepper.hpp"

namespace hybrid_sphere::solver {

/// A solution of Equations as a continuous function of the time: the accepted steps of Stepper are kept
/// as nodes, and between two of them the solution is one shorter step of the same method from the earlier
/// one. The nodes depend on the beginning and the tolerance alone, never on the times that are asked for.
class Trajectory {
 public:
  struct Node {
    State y;
    double step = 0;  ///< in x, to the next node
  };

  /// @param accuracy  wanted error, relative to the scale of motion
  explicit Trajectory(double accuracy);

  /// @param equations  have to live as long as the trajectory is used
  void begin(const Equations& equations, const State& y);

  /// Adds one node. Throws std::runtime_error if the step cannot be taken.
  void extend();

  /// The nodes that are kept, ascending in time; never empty.
  std::size_t size() const { return nodes_.size() - first_; }
  const Node& node(std::size_t i) const { return nodes_[first_ + i]; }
  const State& last() const { return nodes_.back().y; }
  /// Number of nodes that have been let go since the beginning.
  std::size_t forgotten() const { return forgotten_; }

  /// State at a time from that of the first node to that of the last one.
  State at(double time) const;
  /// State a length x after node i.
  State after(std::size_t i, double x) const { return evaluate(nodes_[first_ + i].y, x); }

  /// Lets the nodes go that no time from `time` on needs.
  void forget_before(double time);

  double tolerance() const { return tolerance_; }
  std::uint64_t evaluations() const { return stepper_.evaluations() + evaluations_; }

 private:
  State evaluate(const State& y, double x) const;
  State invert(const Node& node, double end, double time) const;
  void measure(const State& y, double step);

  Stepper stepper_;
  double tolerance_;
  const Equations* equations_ = nullptr;
  std::vector<Node> nodes_;
  std::size_t first_ = 0;
  std::size_t forgotten_ = 0;
  double speed_ = 0;  // scale of the velocities, lately
  State scale_ = State::Ones();
  mutable std::uint64_t evaluations_ = 0;
};

}  // namespace hybrid_sphere::solver
