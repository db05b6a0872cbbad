#include "motion/trajectory.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <string>
#include <utility>

#include "hybrid_sphere/numerical_error.hpp"
#include "motion/step_path.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::numeric {
namespace {

constexpr std::size_t max_steps = 50'000'000;
constexpr std::size_t max_kept = 2'000'000'000;  // [bytes]

/// The greatest rate at which the forces change the motion [1/s].
double rate_of_change(const Equations& equations, const Instant& now) {
  const Dynamics& dynamics = equations.dynamics();
  const double speed = now.velocity.norm();
  return dynamics.translational_drag + dynamics.rotational_drag + dynamics.quadratic_drag * speed +
         std::sqrt(dynamics.quadratic_drag * now.forcing.norm()) + std::sqrt(dynamics.spring_rate) +
         std::abs(equations.turntable_rate());
}

/// Cautious length of the first step in x; what follows adapts itself.
double max_first_step(const Equations& equations, const State& y, double scale) {
  constexpr double caution = 0.01;
  const Instant now = equations.instant(y);
  const double pace = equations.pace(y);
  const double acceleration = now.forcing.norm() + equations.decays();
  double rate = pace * rate_of_change(equations, now);
  if (equations.is_dry()) rate += acceleration;
  if (rate == 0 && now.velocity.norm() > 0) rate = acceleration / now.velocity.norm();
  rate = std::max(rate, pace / scale);
  return rate > 0 ? std::min(caution / rate, max_time / pace) : 1;
}

}  // namespace

Trajectory::Trajectory(const scene::Solver& solver) : integrator_(make_integrator(solver)) {}

void Trajectory::set_solver(const scene::Solver& solver) { next_integrator_ = make_integrator(solver); }

void Trajectory::begin(const Equations& equations, const State& y, double scale) {
  if (next_integrator_) {
    evaluations_ += integrator_->evaluations();
    integrator_ = std::move(next_integrator_);
  }
  equations_ = &equations;
  keep_room(nodes_.size());
  nodes_.clear();
  nodes_.push_back({y});
  make_room(nodes_.back());
  forgotten_ = 0;
  speed_ = 0;
  const double step = integrator_->first_step(equations, y, max_first_step(equations, y, scale));
  measure(y, step);
  integrator_->begin(equations, nodes_.back(), scale_, step);
}

// Scales of motion near a state: speeds, also those of the last few steps, unless these are as long as all
// before, and what a step changes; lengths and times, those since the beginning and of a step. The error of w
// may grow against w itself as w dies, but not so much that w gets lost before it matters. What a number of
// the state is rounded by nothing can be asked to know.
void Trajectory::measure(const State& y, double step) {
  constexpr double longest_memory = 0.9;
  constexpr double worst = 1e-5;
  constexpr double least = 0x1p-900;  // its inverse, over any tolerance, is a number
  const Instant now = equations_->instant(y);
  const double duration = step * equations_->pace(y);
  const double w = pair(y, 0).norm();
  const bool is_double = equations_->dry_vectors() == 2;
  const double nu = is_double ? pair(y, 4).norm() : 0;
  const double forcing = is_double ? now.forcing.norm() + now.spin.norm() : now.forcing.norm();
  const double change = (forcing + equations_->decays()) * duration;
  // The rounding of the place makes the spring's force, and in the time of its change the speed, uncertain.
  const double spring = equations_->dynamics().spring_rate;
  const double told = spring == 0 ? 0
                                  : 8 * DBL_EPSILON / tolerance() * spring * displacement(y).norm() /
                                        rate_of_change(*equations_, now);
  const double memory =
      time_of(y) > 0 ? std::min(longest_memory, time_of(y) / (time_of(y) + duration)) : longest_memory;
  speed_ =
      std::max({now.velocity.norm() + change, w + change, nu + change, memory * speed_, told, least_speed});
  const auto decaying = [&](double size) {
    return std::min(std::sqrt(speed_) * std::sqrt(size), worst * size / tolerance());
  };
  scale_.head<2>() = equations_->decay() != 0 ? decaying(w) : speed_;
  // The velocity may be what p_c and kappa sigma leave of each other: the place knows no more than that.
  const double kappa = equations_->dynamics().kappa;
  const double rounded =
      equations_->form() == EquationForm::sliding ? ((1 - kappa) * now.velocity + kappa * now.nu).norm() : 0;
  scale_.segment<2>(2) =
      displacement(y).norm() + std::max(speed_, 8 * DBL_EPSILON / tolerance() * rounded) * duration;
  scale_.segment<2>(4) = is_double ? decaying(nu) : speed_;
  scale_[6] = time_of(y) + duration;
  scale_[7] = 1;
  if (!is_double) {
    scale_.segment<2>(4) = scale_.segment<2>(4).max(8 * DBL_EPSILON / tolerance() * y.segment<2>(4).abs());
  }
  scale_ = scale_.max(least);
}

void Trajectory::extend() {
  const std::size_t of_a_node = sizeof(Node) + integrator_->largest_shape() * sizeof(State);
  if (forgotten_ + size() > max_steps || size() > max_kept / of_a_node) {
    throw NumericalError("the motion takes too many steps to pass " + text::shortest(time_of(last())) +
                         " s into the segment");
  }
  constexpr std::size_t few_blocks = 8;  // take no longer than a step or two
  nodes_.release(few_blocks);
  try {
    Node& from = nodes_.back();
    Node to = integrator_->step(from, scale_);
    if (!(equations_->instant(to.y).velocity.norm() <= max_speed)) {
      throw NumericalError("its speed exceeds 1e100 m/s");
    }
    errors_ += integrator_->last_error();
    ++steps_;
    if (size() == 1) speed_ = 0;  // that of the step that was tried is no measure of the one taken
    measure(to.y, from.step);
    if (to.shape.empty()) make_room(to);
    if (has_step_paths()) note_bend(to);
    nodes_.push_back(std::move(to));
  } catch (const NumericalError& error) {
    throw NumericalError("the motion cannot be integrated beyond " + text::shortest(time_of(last())) +
                         " s into the segment: " + error.what());
  }
}

double Trajectory::estimated_error() const {
  return errors_ + DBL_EPSILON * std::sqrt(static_cast<double>(steps_));
}

std::size_t Trajectory::index_at(double time) const {
  std::size_t before = 0;
  std::size_t after = size();
  while (after - before > 1) {
    const std::size_t middle = before + (after - before) / 2;
    (time_of(nodes_[middle].y) <= time ? before : after) = middle;
  }
  return before;
}

/// Node k keeps the greatest bend of so many steps as the last bit of k says, so that those of any steps in a
/// row are found by looking at few nodes, whatever has been let go before them.
void Trajectory::note_bend(Node& to) const {
  const std::size_t k = forgotten_ + size();
  to.bend = to.bends = StepPath(nodes_.back(), to, equations_->is_dry()).bend();
  const std::size_t block = k & (~k + 1);
  for (std::size_t back = 1; back < block && k - back >= forgotten_; back *= 2) {
    to.bends = std::max(to.bends, nodes_[k - back - forgotten_].bends);
  }
}

double Trajectory::path_bend(double from, double until) const {
  if (!has_step_paths()) return 0;
  const std::size_t first = forgotten_ + index_at(from) + 1;
  double most = 0;
  for (std::size_t k = std::min(forgotten_ + index_at(until) + 1, forgotten_ + size() - 1); k >= first;) {
    const std::size_t block = k & (~k + 1);
    const bool is_within = k - block + 1 >= first;
    const Node& node = nodes_[k - forgotten_];
    most = std::max(most, is_within ? node.bends : node.bend);
    k -= is_within ? block : 1;
  }
  return most;
}

State Trajectory::at(double time, Vector2d* path_velocity) {
  if (forgotten_ > 0 && time < time_of(nodes_[0].y)) {
    throw NumericalError("the motion at " + text::shortest(time) +
                         " s into the segment has already been forgotten");
  }
  const std::size_t i = index_at(time);
  Node& node = nodes_[i];
  if (time <= time_of(node.y) || i + 1 == size()) return node.y;
  const Node& next = nodes_[i + 1];
  const bool is_dry = equations_->is_dry();
  double x = time - time_of(node.y);
  const State y = is_dry ? invert(node, next, time, x) : integrator_->interpolate(node, next, x);
  if (path_velocity && has_step_paths()) {
    const StepPath path(node, next, is_dry);
    if (path.is_told()) *path_velocity = path.velocity(x);
  }
  if (!y.allFinite()) {
    throw NumericalError("the motion at " + text::shortest(time) + " s into the segment is not finite");
  }
  return y;
}

// Solves tau(x) = time by Halley's method: with one dry vector tau' = |w|, tau'' = w.w'/|w|. The first guess
// is the cubic through the two nodes; the last, tiny correction is made along the derivative.
/// @param x  becomes the length from the first node [of x]
State Trajectory::invert(Node& from, const Node& to, double time, double& x) {
  constexpr double tiny = 1e-9;
  const double span = time_of(to.y) - time_of(from.y);
  const double part = (time - time_of(from.y)) / span;
  const double slope = span / (equations_->pace(from.y) * from.step);
  const double far_slope = span / (equations_->pace(to.y) * from.step);
  const double rest = 1 - part;
  x = from.step * part * (rest * rest * slope + part * (3 - 2 * part) - part * rest * far_slope);
  double low = 0;
  double high = from.step;
  for (int i = 0;; ++i) {
    if (!(x > low && x < high)) x = 0.5 * (low + high);
    const State y = integrator_->interpolate(from, to, x);
    const State rate = equations_->derivative(y);
    ++evaluations_;
    const double missing = time - time_of(y);
    (missing > 0 ? low : high) = x;
    const double pace = rate[6];
    const double newton = missing / pace;
    const double bend = equations_->dry_vectors() == 2 ? equations_->pace_rate(y, rate)
                                                       : pair(y, 0).dot(pair(rate, 0)) / (pace * pace);
    const double correction = newton / (1 + std::max(-0.5, 0.5 * bend * newton));
    if (std::abs(correction) <= tiny * from.step || i == 100) {
      State there = y + correction * rate;
      there[6] = time;
      x = std::clamp(x + correction, 0.0, from.step);
      return there;
    }
    x += correction;
  }
}

void Trajectory::forget_before(double time) {
  std::size_t count = 0;
  while (count + 1 < size() && time_of(nodes_[count + 1].y) <= time) ++count;
  keep_room(count);
  nodes_.pop_front(count);
  forgotten_ += count;
}

void Trajectory::release_memory() {
  constexpr std::size_t some_blocks = 256;  // take a few milliseconds
  nodes_.release(some_blocks);
}

/// For the shape that a node may get when it is looked at.
void Trajectory::make_room(Node& node) {
  if (spare_.empty()) return;
  node.shape.swap(spare_.back());
  spare_.pop_back();
}

/// The room that the shapes of the first nodes took.
void Trajectory::keep_room(std::size_t count) {
  constexpr std::size_t max_spare = 4096;
  count = std::min(count, max_spare);
  for (std::size_t i = 0; i < count && spare_.size() < max_spare; ++i) {
    std::vector<State>& shape = nodes_[i].shape;
    if (shape.capacity() == 0) continue;
    shape.clear();
    spare_.push_back(std::move(shape));
  }
}

}  // namespace hybrid_sphere::numeric
