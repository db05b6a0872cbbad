#include "hybrid_sphere/mechanics/equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "mechanics/active_constraints.hpp"
#include "mechanics/nearby_states.hpp"
#include "mechanics/split_directions.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {
namespace {

constexpr int max_iterations = 100;
// An acceleration of this part of its terms is 0: round-off of forces, and of the functions that give them.
constexpr double max_residual = 1e-10;
constexpr double force_roundoff = 1e-14;  // no step makes it smaller
// Directions in which accelerations change by at most this part of the largest change are neutral:
// differences leave some 1e-11.
constexpr double max_neutral = 1e-8;

/// The largest change of a coordinate by a displacement, in units of itself or of 1.
double relative_to(const Vector& q, const Vector& displacement) {
  return (displacement.array().abs() / q.array().abs().cwiseMax(1.0)).maxCoeff();
}

/// Newton's method for v' = 0 under the constraints that hold.
class Search {
 public:
  Search(const Model& model, const State& guess) : model_(model), start_(guess), nearby_(model, guess) {
    nearby_.move_to(guess.q, guess.v);
  }

  void run() {
    while (iterations_ < max_iterations && residual() > force_roundoff * size()) {
      ++iterations_;
      if (!step()) break;
    }
    if (residual() <= max_residual * size()) return;
    throw NumericalError(
        "no equilibrium is found: after " + std::to_string(iterations_) +
        " iterations of Newton's method the accelerations are " + text::shortest(residual() / size()) +
        " of their terms, where at most " + text::shortest(max_residual) + " is allowed, at " +
        describe(model_, start_.time, nearby_.q(), nearby_.v()) + "; another guess may help");
  }

  const Vector& q() const { return nearby_.q(); }
  const Vector& v() const { return nearby_.v(); }

 private:
  Vector weighted(const Vector& acceleration) const { return nearby_.weights().cwiseProduct(acceleration); }
  double size() const { return nearby_.size_of_acceleration() + change_of_unit_; }
  double residual() const { return weighted(nearby_.motion().acceleration()).norm(); }

  /// @return  whether it has made the residual smaller
  bool step() {
    change_of_unit_ = 0;
    const Matrix places = nearby_.directions() * nearby_.weights().cwiseInverse().asDiagonal();
    const Matrix free = free_directions(places);
    const Vector acceleration = weighted(nearby_.motion().acceleration());
    Matrix slope(acceleration.size(), free.cols());
    for (Index i = 0; i < free.cols(); ++i) {
      Vector direction = Vector::Zero(q().size() + v().size());
      direction.head(q().size()) = places * free.col(i);
      slope.col(i) = weighted(nearby_.change_of_rate(direction).tail(v().size()));
      const double largest = relative_to(q(), direction.head(q().size()));
      if (largest > 0) change_of_unit_ = std::max(change_of_unit_, slope.col(i).norm() / largest);
    }
    const Matrix directions = split_directions(slope, max_neutral * slope.norm()).rest;
    Vector change = Vector::Zero(free.cols());
    for (Index i = 0; i < directions.cols(); ++i) {
      const Vector along = slope * directions.col(i);
      change -= along.dot(acceleration) / along.squaredNorm() * directions.col(i);
    }
    return search_along(places * (free * change));
  }

  /// Directions that keep the constraints on positions, to first order.
  Matrix free_directions(const Matrix& places) {
    const Matrix changes = nearby_.changes_of_constraints(places);
    Matrix conditions = changes.topRows(changes.rows() / 2);
    for (Index i = 0; i < conditions.rows(); ++i) {
      const double length = conditions.row(i).norm();
      if (length > 0) conditions.row(i) /= length;
    }
    return split_directions(conditions, max_neutral).kernel;
  }

  bool search_along(const Vector& change) {
    constexpr int halvings = 40;
    constexpr double least_decrease = 1e-4;  // Armijo's constant
    const Vector q = nearby_.q();
    const Vector v = nearby_.v();
    const double before = residual();
    for (int i = 0; i < halvings; ++i) {
      const double part = std::ldexp(1.0, -i);
      try {
        nearby_.move_to(q + part * change, start_.v);
        if (residual() <= (1 - least_decrease * part) * before) return true;
      } catch (const NumericalError&) {  // the equations have no solution there
      }
    }
    nearby_.move_to(q, v);
    return false;
  }

  const Model& model_;
  State start_;
  NearbyStates nearby_;
  int iterations_ = 0;
  // Change of the residual when a coordinate changes by itself, or by 1: forces that are each 0, as those on
  // a pendulum that hangs, are compared with those nearby.
  double change_of_unit_ = 0;
};

/// @param puts_on  whether the positions are to be put onto the constraints first
State present(const Model& model, const Initial& initial, bool puts_on) {
  Options options;
  options.project_positions = puts_on;
  options.project_initial = true;
  const Solution motion = solve(model, initial, 0, options);
  const Status& status = motion.status();
  if (status.stop != Stop::reached_end) throw NumericalError("no equilibrium: " + status.message);
  return motion.at(initial.time);
}

/// Whatever slides at the guess is to hold in the equilibrium.
ActiveSet holding(const State& state) {
  ActiveSet set = state.active;
  for (const Slide& slide : state.sliding) set.push_back(slide.constraint);
  std::sort(set.begin(), set.end());
  return set;
}

}  // namespace

State equilibrium(const Model& model, const Initial& guess) {
  State start = present(model, guess, true);
  start.active = guess.active ? *guess.active : holding(start);
  start.sliding.clear();
  Search search(model, start);
  search.run();
  const State found = present(model, {start.time, search.q(), search.v(), start.active}, false);
  ActiveSet lost;
  for (const std::size_t i : start.active) {
    if (!contains(found.active, i)) lost.push_back(i);
  }
  if (lost.empty()) return found;
  throw NumericalError("no equilibrium is found: the constraints " + names(model, lost) +
                       " would not hold there: a contact would lift off, or a friction slide, at " +
                       describe(model, start.time, found.q, found.v));
}

}  // namespace hybrid_sphere::mechanics
