#include "hybrid_sphere/mechanics/impulse.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <limits>
#include <sstream>
#include <utility>

#include "interrupt/interrupt.hpp"
#include "mechanics/impulse_equations.hpp"

namespace hybrid_sphere::mechanics {
namespace {

using Reason = ConstraintError::Reason;
using Outcome = SaddlePoint::Outcome;

// Newton's method ends where residuals are this part of the sizes of their terms.
double rounding_tolerance(Index n) { return static_cast<double>(32 + n) * DBL_EPSILON; }

// Steps that do not shrink any more below this part of the velocities are noise of the user's functions.
constexpr double noise_tolerance = 0x1p-30;

// A step of Newton's method has to be shorter than the one before by this factor.
constexpr double contraction = 0.75;

// Over a part of the path no df/dv may turn by more than the angle of this cosine.
constexpr double least_cosine = 0.5;

constexpr int max_steps = 40;                 // towards one point of the path
constexpr int max_path_iterations = 500;      // along the path; as many again downhill
constexpr double shortest_advance = 0x1p-20;  // along the path
constexpr double shortest_part = 0x1p-30;     // of a step downhill
constexpr double least_descent = 0x1p-10;     // of what the slope promises
constexpr int max_refinements = 3;

constexpr std::uint32_t turns_of_a_step = 4;

enum class End { converged, diverged, inconsistent, singular, not_finite };

void show(std::ostream& out, const std::vector<std::string>& names, const Vector& values) {
  for (Index i = 0; i < values.size(); ++i) {
    out << (i == 0 ? "" : ", ") << names[static_cast<std::size_t>(i)] << " = " << values[i];
  }
}

}  // namespace

/// From v1 the method follows the path on which p(v) - p(v1) = C^T Lambda and f(v) = (1 - s) f(v1), s from 0
/// to 1: the whole of it in one go where Newton's steps shrink all the way, half of it where not, and so on.
/// Every point of the path is a local minimum of the distance from v1 (of T(v - v1), where L is quadratic)
/// among the velocities of its f, as its start is. Where the path ends before s = 1, because the minimum is
/// none any more, the same steps go downhill in distance and abs(f) together, from v1 to another minimum.
struct ImpulseSolver::Impl {
  explicit Impl(const Model& of) : model(&of), equations(of) {}

  const Model* model;
  ImpulseEquations equations;
  double t = 0;
  const Vector* q = nullptr;
  ImpulsePoint here;
  ImpulsePoint start;  // of a part of the path
  ImpulsePoint trial;
  ImpulseStep step;
  Vector penalty;  // (g)
  int iterations = 0;
  std::string not_finite;

  void solve(Impulse& result);
  void refuse_zero_rows(const ImpulsePoint& point);
  bool depends_on_velocity(Index row);
  bool follow();
  End newton(double share);
  bool contradicts(double share) const;
  End converge(double share, double length);
  bool is_minimum();
  bool keeps_directions() const;
  bool descend();
  bool go_downhill();
  void refine();
  void stop_what_hardly_moves(double residual);
  void finish(Impulse& result);
  double strict() const { return strict_tolerance(here.v.size()); }
  std::string place(const Vector& v) const;
  [[noreturn]] void refuse_inconsistent() const;
  [[noreturn]] void refuse_singular() const;
  [[noreturn]] void refuse_no_velocity() const;
};

void ImpulseSolver::Impl::solve(Impulse& result) {
  iterations = 0;
  not_finite.clear();
  refuse_zero_rows(equations.before());
  here = equations.before();
  if (residual_of(here) > strict()) {
    if (!follow() && !descend()) refuse_no_velocity();
    refine();
    refuse_zero_rows(here);
    if (!equations.is_solved_in_the_mean(here, 0, noise_tolerance)) refuse_no_velocity();
  }
  finish(result);
}

void ImpulseSolver::Impl::refuse_zero_rows(const ImpulsePoint& point) {
  for (Index b = 0; b < point.f.size(); ++b) {
    if ((point.gradient.row(b).array() != 0).any()) continue;
    std::string message =
        equations.constraints().name_of(b) + " has no direction: df/dv = 0 at " + place(point.v);
    if (!depends_on_velocity(b)) {
      message += "; it does not depend on the velocities: differentiate it once with respect to time";
    }
    throw ConstraintError(Reason::no_direction, message);
  }
}

// By two velocities that have nothing in common with each other.
bool ImpulseSolver::Impl::depends_on_velocity(Index row) {
  trial = equations.before();
  for (const double ratio : {0.75, -1.25}) {
    double component = 1;
    for (Index s = 0; s < trial.v.size(); ++s) {
      trial.v[s] = component;
      component *= ratio;
    }
    try {
      equations.evaluate_constraints(trial);
    } catch (const NotFinite&) {
      return true;
    }
    if ((trial.gradient.row(row).array() != 0).any()) return true;
  }
  return false;
}

/// @return whether the path has led to f = 0
bool ImpulseSolver::Impl::follow() {
  double share = 1;  // of f(v1) that f(here) is
  double advance = 1;
  while (share > 0) {
    const double next = std::max(0.0, share - advance);
    start = here;
    const End end = newton(next);
    if (end == End::converged && keeps_directions()) {
      share = next;
      advance *= 2;
      continue;
    }
    if (end == End::inconsistent) refuse_inconsistent();
    if (end == End::singular && iterations == 0) refuse_singular();
    std::swap(here, start);
    advance /= 2;
    if (advance < shortest_advance || iterations > max_path_iterations) return false;
  }
  return true;
}

/// Moves `here` to f = share f(v1).
End ImpulseSolver::Impl::newton(double share) {
  double previous = std::numeric_limits<double>::infinity();
  try {
    for (int i = 0; i < max_steps; ++i) {
      interruption_point(turns_of_a_step);
      equations.find_step(here, share, step);
      if (step.outcome == Outcome::singular) return End::singular;
      const double length = equations.saddle_point().length(step.dv);
      if (!(length < contraction * previous) || i + 1 == max_steps) return converge(share, length);
      previous = length;
      here.v += step.dv;
      std::swap(here.multipliers, step.multipliers);
      ++iterations;
      equations.evaluate(here);
      if (equations.is_solved(here, share, rounding_tolerance(here.v.size()))) {
        return is_minimum() ? End::converged : End::diverged;
      }
    }
  } catch (const NotFinite& error) {
    not_finite = error.what();
    return End::not_finite;
  }
  return step.outcome == Outcome::inconsistent ? End::inconsistent : End::diverged;
}

/// Whether rows that leave no step contradict each other by more than the rounding of the velocities: those
/// whose terms are nothing but that may do so by as much as they are.
bool ImpulseSolver::Impl::contradicts(double share) const {
  const SaddlePoint& scales = equations.saddle_point();
  const double speed = scales.length(here.v);
  for (Index b = 0; b < here.f.size(); ++b) {
    const double size = speed * here.gradient.row(b).transpose().cwiseProduct(scales.scale()).norm();
    const double off = std::abs(here.f[b] - share * equations.before().f[b]);
    if (!(off <= rounding_tolerance(here.v.size()) * size)) return true;
  }
  return false;
}

/// Steps that do not shrink any more, or velocities of 0 that shrink endlessly: round-off, or no success.
End ImpulseSolver::Impl::converge(double share, double length) {
  if (step.outcome == Outcome::inconsistent) return contradicts(share) ? End::inconsistent : End::converged;
  const SaddlePoint& scales = equations.saddle_point();
  const double size = scales.length(here.v) + scales.length(equations.before().v);
  const bool settled = length <= noise_tolerance * size && step.definite &&
                       equations.is_solved_in_the_mean(here, share, noise_tolerance);
  return settled ? End::converged : End::diverged;
}

bool ImpulseSolver::Impl::is_minimum() {
  if (!step.definite) equations.find_step(here, 0, step);
  return step.definite;
}

/// Whether df/dv of each constraint points to the same side as at the start of this part of the path, in the
/// metric of the diagonal of M: beyond an extremum of f another solution lies, to which v1 does not lead.
bool ImpulseSolver::Impl::keeps_directions() const {
  for (Index b = 0; b < here.f.size(); ++b) {
    double product = 0;
    double square_here = 0;
    double square_start = 0;
    for (Index s = 0; s < here.v.size(); ++s) {
      const double mass = here.mass(s, s);
      if (!(mass > 0)) continue;
      product += here.gradient(b, s) * start.gradient(b, s) / mass;
      square_here += here.gradient(b, s) * here.gradient(b, s) / mass;
      square_start += start.gradient(b, s) * start.gradient(b, s) / mass;
    }
    if (product < least_cosine * std::sqrt(square_here) * std::sqrt(square_start)) return false;
  }
  return true;
}

/// From v1 downhill, until Newton's method takes over.
bool ImpulseSolver::Impl::descend() {
  here = equations.before();
  penalty.setZero(here.f.size());
  const int last = iterations + max_path_iterations;
  while (iterations < last) {
    interruption_point(turns_of_a_step);
    if (!go_downhill()) break;
    trial = here;
    if (newton(0) == End::converged) return true;
    std::swap(here, trial);
  }
  return false;
}

/// One step along which the distance from v1 plus penalty times abs(f) falls. The change of the distance is
/// that of p - p(v1) along dv by the trapezoidal rule, which is exact where L is quadratic.
bool ImpulseSolver::Impl::go_downhill() {
  try {
    equations.find_step(here, 0, step);
    if (step.outcome != Outcome::regular && step.outcome != Outcome::redundant) return false;
    penalty = penalty.cwiseMax(2 * step.multipliers.cwiseAbs());
    const double pull = (here.p - equations.before().p).dot(step.dv);
    const double slope = pull - penalty.dot(here.f.cwiseAbs());
    for (double part = 1; part >= shortest_part; part /= 2) {
      start.v = here.v + part * step.dv;
      start.multipliers = step.multipliers;
      try {
        equations.evaluate(start);
      } catch (const NotFinite&) {
        continue;
      }
      const double pull_there = (start.p - equations.before().p).dot(step.dv);
      const double change =
          part * (pull + pull_there) / 2 + penalty.dot(start.f.cwiseAbs() - here.f.cwiseAbs());
      if (!(change <= least_descent * part * slope)) continue;
      ++iterations;
      std::swap(here, start);
      return true;
    }
  } catch (const NotFinite& error) {
    not_finite = error.what();
  }
  return false;
}

/// Takes f from rounding level of v1 to that of v2, which can be much smaller.
void ImpulseSolver::Impl::refine() {
  double residual = residual_of(here);
  trial.v = here.v;
  try {
    for (int i = 0; i < max_refinements && residual > strict(); ++i) {
      equations.find_step(here, 0, step);
      if (step.outcome == Outcome::inconsistent && contradicts(0)) refuse_inconsistent();
      if (step.outcome == Outcome::inconsistent || step.outcome == Outcome::singular) break;
      trial.v = here.v + step.dv;
      trial.multipliers = step.multipliers;
      equations.evaluate(trial);
      const double next = residual_of(trial);
      if (!(next <= residual / 2)) break;
      residual = next;
      std::swap(here, trial);
    }
    if (residual > strict()) stop_what_hardly_moves(residual);
  } catch (const NotFinite&) {
    return;
  }
}

/// A velocity that is 0 up to the rounding of the others and of v1, or that the last refinement takes away
/// (in `trial`), becomes 0, if that is nearer to f = 0.
void ImpulseSolver::Impl::stop_what_hardly_moves(double residual) {
  constexpr double nothing = 0x1p-20;
  const SaddlePoint& scales = equations.saddle_point();
  const double size = scales.length(equations.before().v) + scales.length(here.v);
  for (Index s = 0; s < here.v.size(); ++s) {
    const double mass = here.mass(s, s);
    const double moves = std::sqrt(mass) * std::abs(here.v[s]);
    const bool is_taken =
        moves <= noise_tolerance * size && std::abs(trial.v[s]) <= nothing * std::abs(here.v[s]);
    const bool hardly = is_taken || moves <= rounding_tolerance(here.v.size()) * size;
    trial.v[s] = mass > 0 && hardly ? 0 : here.v[s];
  }
  trial.multipliers = here.multipliers;
  equations.evaluate(trial);
  if (!(residual_of(trial) <= residual / 2)) return;
  // The multipliers are those of the velocities as they are now: if rows are nearly parallel, a velocity that
  // is round-off of the others belongs to multipliers that differ by more than the balance of p allows.
  equations.find_step(trial, 0, step);
  const bool is_solved = step.outcome == Outcome::regular || step.outcome == Outcome::redundant;
  if (is_solved) std::swap(trial.multipliers, step.multipliers);
  std::swap(here, trial);
}

void ImpulseSolver::Impl::finish(Impulse& result) {
  result.velocity = here.v;
  result.multipliers = here.multipliers;
  result.impulse.setZero(here.v.size());
  if (iterations > 0) result.impulse.noalias() += here.gradient.transpose() * here.multipliers;
  if (!(result.multipliers.allFinite() && result.impulse.allFinite())) throw NotFinite("the impulse");
  const bool same = iterations > 0 && here.gradient == equations.before().gradient;
  result.rank = same ? equations.saddle_point().rank() : equations.rank(here);
  result.iterations = iterations;
}

std::string ImpulseSolver::Impl::place(const Vector& v) const { return describe(*model, t, *q, v); }

void ImpulseSolver::Impl::refuse_inconsistent() const {
  const ActiveSet conflict = equations.constraints().owners(equations.saddle_point().conflict());
  const std::string who = conflict.size() == 1
                              ? "constraint " + names(*model, conflict) + " contradicts itself"
                              : "the constraints " + names(*model, conflict) + " contradict each other";
  throw ConstraintError(Reason::inconsistent, who + ": no velocity satisfies all of their functions, at " +
                                                  place(equations.before().v));
}

void ImpulseSolver::Impl::refuse_singular() const {
  throw ConstraintError(Reason::singular,
                        "the mass matrix M = d2L/dv2 is not positive definite on the velocities that the "
                        "constraints " +
                            names(*model, equations.constraints().active()) + " leave free, at " +
                            place(equations.before().v));
}

void ImpulseSolver::Impl::refuse_no_velocity() const {
  std::ostringstream message;
  message.precision(12);
  const bool has_velocity = residual_of(here) <= strict();
  const std::string who = names(*model, equations.constraints().active());
  message << (has_velocity ? "no impulse was found for " : "no velocity with f = 0 was found for ") << who
          << (has_velocity ? ", which depend on one another up to round-off" : "")
          << ": Newton's method from " << place(equations.before().v) << " ends at ";
  show(message, model->velocities, here.v);
  message << " with f = ";
  for (Index b = 0; b < here.f.size(); ++b) message << (b == 0 ? "" : ", ") << here.f[b];
  if (!not_finite.empty()) message << "; beyond, " << not_finite;
  throw ConstraintError(Reason::no_velocity, message.str());
}

ImpulseSolver::ImpulseSolver(const Model& model) : impl_(std::make_unique<Impl>(model)) {}
ImpulseSolver::~ImpulseSolver() = default;
ImpulseSolver::ImpulseSolver(ImpulseSolver&&) noexcept = default;

void ImpulseSolver::solve(const ActiveSet& active, double t, const Vector& q, const Vector& v1,
                          Impulse& result) {
  if (active.empty()) {
    result.velocity = v1;
    result.multipliers.resize(0);
    result.impulse.setZero(v1.size());
    result.rank = 0;
    result.iterations = 0;
    return;
  }
  impl_->t = t;
  impl_->q = &q;
  impl_->equations.place(active, t, q);
  impl_->equations.begin(v1);
  impl_->solve(result);
}

double ImpulseSolver::relative_residual(const ActiveSet& active, double t, const Vector& q, const Vector& v) {
  ImpulsePoint& point = impl_->trial;
  point.v = v;
  impl_->equations.place(active, t, q);
  impl_->equations.evaluate_constraints(point);
  return residual_of(point);
}

}  // namespace hybrid_sphere::mechanics
