// What happens within a step: guards that change their sign, constraints that lose their direction.
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cfloat>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "integration/bracketed_root.hpp"
#include "interrupt/interrupt.hpp"
#include "mechanics/event_rules.hpp"
#include "mechanics/guards.hpp"
#include "mechanics/segment_impl.hpp"

namespace hybrid_sphere::mechanics {
namespace {

/// Whether a row is another direction at the end of a step, by components relative to their sizes.
bool turns_round(const Matrix& before, const Matrix& after, Index row) {
  constexpr double turned = -0.5;  // cosine
  double product = 0;
  double square_before = 0;
  double square_after = 0;
  for (Index s = 0; s < before.cols(); ++s) {
    const double size = std::max({std::abs(before(row, s)), std::abs(after(row, s)), DBL_MIN});
    const double a = before(row, s) / size;
    const double b = after(row, s) / size;
    product += a * b;
    square_before += a * a;
    square_after += b * b;
  }
  return !(product > turned * std::sqrt(square_before * square_after));
}

}  // namespace

// A constraint whose df/dv turns round within a step may have lost its direction on the way, where nothing
// says how the motion goes on; a step may pass over that place. Components of df/dv have units of their own:
// each counts relative to what it is at the ends of the step, and the direction is lost where all of them
// are.
void SegmentIntegrator::Impl::require_directions(const Node& from) {
  constexpr double lost = 1e-5;
  constexpr int bits = 24;
  const double end = segment->nodes.back().x;
  for (Index row = 0; row < gradient.rows(); ++row) {
    if (!turns_round(gradient_before, gradient, row)) continue;
    const Eigen::ArrayXd sizes =
        gradient_before.row(row).array().abs().max(gradient.row(row).array().abs()).max(DBL_MIN);
    const auto largest = [&](double x) {
      const Node there = motion_step.reach(segment->start, from, x);
      q = there.y.head(q.size());
      v = there.y.tail(v.size());
      motion.evaluate_stage(segment->start + x, q, v);
      return (motion.gradient().row(row).array().abs().transpose() / sizes).maxCoeff();
    };
    const auto least_of = [&](double x) {
      try {
        return largest(x);
      } catch (const ConstraintError&) {
        return 0.0;  // it is where the direction is lost that nothing can be solved
      }
    };
    const auto [x, least] = boost::math::tools::brent_find_minima(least_of, from.x, end, bits);
    if (least > lost) continue;
    segment->nodes.pop_back();
    throw ConstraintError(ConstraintError::Reason::no_direction,
                          "constraint " + model.constraints[motion.owner(row)].name +
                              " has no direction: df/dv = 0 near " +
                              describe(model, segment->start + x, q, v));
  }
}

/// A guard of positions may be off by the rounding of q. A gap that is closed within it counts as closed once
/// the bodies approach each other, so that low bounces do not sink into the ground; by more than the rounding
/// of the velocities, or each of them would.
bool SegmentIntegrator::Impl::changed(const MonitoredGuard& monitored, const Node& node) {
  const double value = value_of(monitored, node.x, node.y);
  if (monitored.kind == MonitoredGuard::Kind::event) {
    return (monitored.positive ? -value : value) > monitored.rounding;
  }
  if (monitored.kind != MonitoredGuard::Kind::position) return value < -size_of(monitored);
  const double t = segment->start + node.x;
  const Guard& guard = guard_of(monitored);
  const int sign = sign_of(guard, t, node.y.head(q.size()), sizes_at(node));
  if (sign != 0 || monitored.positive || !model.constraints[monitored.constraint].unilateral) {
    return monitored.positive ? sign < 0 : sign > 0;
  }
  q = node.y.head(q.size());
  v = node.y.segment(q.size(), v.size());
  model.equations->rate(q, v, q_rate);
  return guard.value(t, q) >= 0 && sign_of_rate(guard, t, q, q_rate, rate_sizes) > 0;
}

/// Evaluates the motion at a state, unless the last evaluation was there: several guards share it.
void SegmentIntegrator::Impl::evaluate_stage(double t, const Vector& state) {
  const std::uint64_t& evaluations = motion.effort().evaluations;
  const bool is_last = evaluated.evaluations > 0 && evaluated.evaluations == evaluations;
  if (is_last && evaluated.t == t && evaluated.state == state) return;
  evaluated.evaluations = 0;
  q = state.head(q.size());
  v = state.segment(q.size(), v.size());
  motion.evaluate_stage(t, q, v);
  evaluated = {t, state, evaluations};
}

double SegmentIntegrator::Impl::value_of(const MonitoredGuard& monitored, double x, const Vector& state) {
  const double t = segment->start + x;
  q = state.head(q.size());
  v = state.segment(q.size(), v.size());
  if (monitored.kind == MonitoredGuard::Kind::position) return guard_of(monitored).value(t, q);
  if (monitored.kind == MonitoredGuard::Kind::event) {
    return mechanics::value_of(model.events[monitored.constraint], t, q, v);
  }
  evaluate_stage(t, state);
  if (monitored.kind == MonitoredGuard::Kind::slip) {
    return motion.friction().slip(monitored.constraint) - slip_that_ends(monitored);
  }
  const Vector all = motion.multipliers();
  if (monitored.kind == MonitoredGuard::Kind::reaction) {
    return all[model.multiplier_of(monitored.constraint)];
  }
  const Friction& friction = *model.constraints[monitored.constraint].friction;
  return friction.of_sticking() * load_of(model, friction, t, q, v, all) -
         std::abs(motion.multiplier(monitored.constraint));
}

/// A slip of two components need not pass 0, near which its direction turns ever faster: it ends where it is
/// as slow as the error of the motion, if it has been faster at the step's start.
double SegmentIntegrator::Impl::slip_that_ends(const MonitoredGuard& monitored) const {
  const double at_start = motion.friction().speed_at_start(monitored.constraint);
  if (at_start == 0) return 0;
  const double slow = slowest_slip(monitored.constraint);
  return at_start > slow - size_of(monitored) ? slow : 0;
}

/// The speed below which a slip of two components has ended: a part of the error of the motion, rounding, or
/// what it loses before the clock can tell.
double SegmentIntegrator::Impl::slowest_slip(std::size_t friction) const {
  constexpr double part = 0.1;
  constexpr double times = 4;
  const auto size = [&](const Vector& speeds) { return motion.friction().slip_size(friction, speeds); };
  const double lost = size(segment->resolution(segment->nodes.back().x) * motion.acceleration());
  return std::max({part * demand.accuracy * size(scale.values().tail(v.size())), times * lost,
                   times * size_of({friction, true, MonitoredGuard::Kind::slip})});
}

/// Of the state at which the motion has been evaluated: lambda, or f of what slides; smooth, where the motion
/// is, and, with two components, where lambda is not 0.
double SegmentIntegrator::Impl::smooth_value(const MonitoredGuard& monitored) const {
  if (monitored.kind == MonitoredGuard::Kind::slip) return motion.friction().slip(monitored.constraint);
  return motion.multiplier(monitored.constraint);
}

double SegmentIntegrator::Impl::size_of_terms(const MonitoredGuard& monitored) const {
  if (monitored.kind == MonitoredGuard::Kind::slip) {
    return motion.friction().slip_size(monitored.constraint, scale.values().tail(v.size()));
  }
  const double size = motion.multiplier_size(monitored.constraint);
  if (monitored.kind != MonitoredGuard::Kind::limit) return size;
  // lambda may be nothing but rounding beside what it is compared with, mu N.
  const Friction& friction = *model.constraints[monitored.constraint].friction;
  const double t = segment->start + segment->nodes.back().x;
  const double load = load_of(model, friction, t, q, v, motion.multipliers());
  return std::max(size, friction.of_sticking() * std::abs(load));
}

/// What rounding, and for slips the error of a step, may do to the last value.
double SegmentIntegrator::Impl::size_of(const MonitoredGuard& monitored) const {
  constexpr double rounding = 1e-12;
  if (monitored.kind == MonitoredGuard::Kind::slip) {
    const SlidingFriction& friction = motion.friction();
    return std::max(rounding, 1e-3 * demand.accuracy) * friction.slip_size(monitored.constraint, v) +
           16 * DBL_EPSILON * friction.slip_size(monitored.constraint, scale.values().tail(v.size()));
  }
  const auto of_multiplier = [this](std::size_t constraint) {
    return std::max(rounding * motion.multiplier_size(constraint), motion.multiplier_rounding(constraint));
  };
  const double size = of_multiplier(monitored.constraint);
  if (monitored.kind != MonitoredGuard::Kind::limit) return size;
  const Friction& friction = *model.constraints[monitored.constraint].friction;
  if (!friction.contact) return size;
  return size + friction.of_sticking() * of_multiplier(*friction.contact);
}

// Those of an interpolant that is less accurate than the steps: they only tell where to look.
std::vector<double> SegmentIntegrator::Impl::places_to_check(const Node& from, const Node& reached) {
  std::vector<double> places;
  reaction_values.clear();
  for (std::size_t i = 0; i < guards.size(); ++i) {
    const MonitoredGuard& monitored = guards[i];
    const bool is_function =
        monitored.kind == MonitoredGuard::Kind::position || monitored.kind == MonitoredGuard::Kind::event;
    const bool is_position = monitored.kind == MonitoredGuard::Kind::position;
    const double most_roundoff = is_position ? std::max(rounding_at(monitored, from.x, from.y),
                                                        rounding_at(monitored, reached.x, reached.y))
                                             : 0;
    const auto sample_at = [&](double x, const Vector& state) {
      return is_position ? sample_guard(monitored, x, state, most_roundoff)
                         : sample_event(monitored, x, state, reached.x - from.x);
    };
    const auto sample = [&](double x) {
      if (!is_function) return sample_reaction(i, x, from.x, reached.x);
      motion_step.interpolate(x, interpolated);
      return sample_at(x, interpolated);
    };
    const GuardSample low = is_function ? sample_at(from.x, from.y) : sample(from.x);
    const GuardSample high = is_function ? sample_at(reached.x, reached.y) : sample(reached.x);
    search_guard(sample, low, high, places);
  }
  std::sort(places.begin(), places.end());
  places.push_back(reached.x);
  return places;
}

/// Bound on the value of a guard of positions that round-off of t and of the present q can cause.
double SegmentIntegrator::Impl::rounding_at(const MonitoredGuard& monitored, double x,
                                            const Vector& state) const {
  const Vector at = state.head(q.size());
  return rounding_of(guard_of(monitored), segment->start + x, at, at.cwiseAbs());
}

/// On the boundary of a guard, up to round-off, a motion counts as still on its previous side.
/// @param most_roundoff  the greater round-off of the step's ends: values far above it are none
GuardSample SegmentIntegrator::Impl::sample_guard(const MonitoredGuard& monitored, double x,
                                                  const Vector& state, double most_roundoff) {
  constexpr double many = 100;  // above it the round-off, which costs N + 1 rates, is not computed
  double value = value_of(monitored, x, state);
  double roundoff = 0;
  if (std::abs(value) <= many * most_roundoff) roundoff = rounding_at(monitored, x, state);
  if (std::abs(value) <= roundoff) value = monitored.positive ? DBL_MIN : -DBL_MIN;
  model.equations->rate(q, v, q_rate);
  return {x, value, guard_of(monitored).rate(segment->start + x, q, q_rate), roundoff};
}

/// The rate by a difference along the tangent.
GuardSample SegmentIntegrator::Impl::sample_event(const MonitoredGuard& monitored, double x,
                                                  const Vector& state, double h) {
  constexpr double part = 1e-5;
  const Event& event = model.events[monitored.constraint];
  const double t = segment->start + x;
  double value = value_of(monitored, x, state);
  if ((monitored.positive ? -value : value) <= monitored.rounding && (value > 0) != monitored.positive) {
    value = monitored.positive ? DBL_MIN : -DBL_MIN;
  }
  motion.evaluate_stage(t, q, v);
  return {x, value, change_of(event, t, q, v, motion, part * h) / (2 * part * h)};
}

const std::vector<SegmentIntegrator::Impl::ReactionValue>& SegmentIntegrator::Impl::reactions_at(double x) {
  const auto known = reaction_values.find(x);
  if (known != reaction_values.end()) return known->second;
  motion_step.interpolate(x, interpolated);
  std::vector<ReactionValue> values(guards.size());
  for (std::size_t i = 0; i < guards.size(); ++i) {
    const MonitoredGuard::Kind kind = guards[i].kind;
    if (kind == MonitoredGuard::Kind::position || kind == MonitoredGuard::Kind::event) continue;
    const double value = value_of(guards[i], x, interpolated);
    values[i] = {value, size_of(guards[i])};
  }
  return reaction_values[x] = std::move(values);
}

/// On the interpolant, the rate by a difference. Round-off counts as the side on which the guard has been.
GuardSample SegmentIntegrator::Impl::sample_reaction(std::size_t guard, double x, double low, double high) {
  constexpr double part = 1e-4;
  const double half = std::max(part * (high - low), 4 * DBL_EPSILON * high);
  const double before = std::max(low, x - half);
  const double after = std::min(high, x + half);
  const ReactionValue earlier = reactions_at(before)[guard];
  const ReactionValue later = reactions_at(after)[guard];
  const double roundoff = std::max(earlier.roundoff, later.roundoff);
  if (earlier.is_roundoff() && later.is_roundoff()) return {x, DBL_MIN, 0, roundoff};
  const double rate = after > before ? (later.value - earlier.value) / (after - before) : 0;
  const double value = earlier.value + rate * (x - before);
  return {x, std::abs(value) <= roundoff ? DBL_MIN : value, rate, roundoff};
}

std::optional<Node> SegmentIntegrator::Impl::first_change(const Node& from, const Node& reached) {
  passed.clear();
  if (guards.empty()) return std::nullopt;
  constexpr std::uint32_t turns_of_a_step = 16;
  double low = from.x;
  for (const double place : places_to_check(from, reached)) {
    if (!(place > low)) continue;
    interruption_point(turns_of_a_step);
    const Node there = place == reached.x ? reached : motion_step.reach(segment->start, from, place);
    double first = std::numeric_limits<double>::infinity();
    for (const MonitoredGuard& monitored : guards) {
      if (!changed(monitored, there)) continue;
      const double instant = instant_of_change(monitored, from, low, there);
      if (instant < first) passed.clear();
      first = std::min(first, instant);
      if (instant != first) continue;
      passed.push_back(monitored);
      constexpr double across = 2;  // the end is seen along the slip's direction at the step's start
      if (monitored.kind == MonitoredGuard::Kind::slip && motion.friction().turns()) {
        passed.back().rounding = across * slowest_slip(monitored.constraint);
      }
    }
    if (first <= place) {
      const Node change = motion_step.reach(segment->start, from, first);
      add_simultaneous(change, there);
      return change;
    }
    // Beyond a root by less than rounding, it is before this place.
    const bool is_before = std::none_of(guards.begin(), guards.end(), [&](const MonitoredGuard& monitored) {
      return (value_of(monitored, place, there.y) > 0) != monitored.positive;
    });
    if (is_before) low = place;
  }
  return std::nullopt;
}

/// Reactions and limits that change up to `there` and are 0 within rounding at the first change: a contact
/// that carries nothing any more, and its friction.
void SegmentIntegrator::Impl::add_simultaneous(const Node& change, const Node& there) {
  constexpr double roundings = 16;  // the instant is known only as well as the first guard
  for (const MonitoredGuard& monitored : guards) {
    const bool is_of_forces =
        monitored.kind == MonitoredGuard::Kind::reaction || monitored.kind == MonitoredGuard::Kind::limit;
    if (!is_of_forces || !changed(monitored, there)) continue;
    const auto is_it = [&](const MonitoredGuard& other) {
      return other.constraint == monitored.constraint && other.kind == monitored.kind;
    };
    if (std::any_of(passed.begin(), passed.end(), is_it)) continue;
    const double value = value_of(monitored, change.x, change.y);
    if (value <= roundings * size_of(monitored)) passed.push_back(monitored);
  }
}

/// A place after low, if low has the wrong sign by rounding, at which the value has the right one. The
/// interpolant says where to look.
double SegmentIntegrator::Impl::place_before_change(const std::function<double(double)>& value,
                                                    const std::function<double(double)>& interpolated_value,
                                                    const MonitoredGuard& monitored, double low,
                                                    double high) {
  constexpr double nearest = 1e-12;
  const auto is_right = [&](double at_x) { return at_x != 0 && (at_x > 0) == monitored.positive; };
  if (is_right(value(low))) return low;
  for (double part = 0.5; part > nearest; part /= 2) {
    const double x = low + part * (high - low);
    if (is_right(interpolated_value(x)) && is_right(value(x))) return x;
  }
  return low;
}

/// By the root on the interpolant, and by a step of Newton's method from there that goes twice as far.
void SegmentIntegrator::Impl::narrow(const std::function<double(double)>& value,
                                     const std::function<double(double)>& interpolated_value,
                                     Change& change) {
  constexpr double part = 1e-4;
  const double at_low = interpolated_value(change.low);
  const double at_high = interpolated_value(change.high);
  if (at_low == 0 || at_high == 0 || (at_low > 0) == (at_high > 0)) return;
  const integration::Bracket bracket =
      integration::bracketed_root(interpolated_value, change.low, change.high, at_low, at_high);
  const double half = part * (change.high - change.low);
  const double slope =
      (interpolated_value(bracket.high + half) - interpolated_value(bracket.low - half)) / (2 * half);
  const auto see = [&](double x) {
    if (!(change.low < x && x < change.high)) return 0.0;
    const double at_x = value(x);
    if (at_x == 0) return 0.0;
    const bool is_before = (at_x > 0) == (change.at_low > 0);
    (is_before ? change.low : change.high) = x;
    (is_before ? change.at_low : change.at_high) = at_x;
    return at_x;
  };
  const double off = see(bracket.low);
  if (off != 0) see(bracket.low - 2 * off / slope);
}

/// @param there  at the end of the piece in which it changes
double SegmentIntegrator::Impl::instant_of_change(const MonitoredGuard& monitored, const Node& from,
                                                  double low, const Node& there) {
  const double high = there.x;
  // A low bounce begins with a gap that is 0 for as long as rounding hides it, and ends where the bodies
  // approach each other. So does any motion that begins on the edge of a guard.
  const bool is_position = monitored.kind == MonitoredGuard::Kind::position;
  const bool is_gap = is_position && model.constraints[monitored.constraint].unilateral.has_value();
  const int side = monitored.positive ? 1 : -1;  // before the change
  double hidden = 0;                             // overlap that is rounding
  double rounding = 0;
  if (is_position) {
    const Node at_low = motion_step.reach(segment->start, from, low);
    const double overlap = value_of(monitored, low, at_low.y);
    rounding = rounding_at(monitored, low, at_low.y);
    if (is_gap && !monitored.positive && overlap > 0) {
      hidden = std::max(overlap, rounding_of(guard_of(monitored), segment->start + low,
                                             at_low.y.head(q.size()), sizes_at(at_low)));
    }
  }
  const double before = side * std::max(DBL_MIN, rounding);
  const auto value = [&](double x) {
    const double at_x = value_of(monitored, x, motion_step.reach(segment->start, from, x).y) - hidden;
    if (monitored.kind == MonitoredGuard::Kind::event && at_x == 0) return before;
    if (!is_position || side * at_x > 0 || std::abs(at_x) > rounding) return at_x;
    model.equations->rate(q, v, q_rate);
    return side * guard_of(monitored).rate(segment->start + x, q, q_rate) < 0 ? at_x : before;
  };
  const auto on_interpolant = [&](double x) {
    motion_step.interpolate(x, interpolated);
    return value_of(monitored, x, interpolated) - hidden;
  };
  // At low the guard has not changed: what its value says otherwise is rounding. What begins on its zero, as
  // slips do, first goes the right way.
  if (!is_position) low = place_before_change(value, on_interpolant, monitored, low, high);
  const double low_value = value(low);
  const double at_low = (low_value > 0) == monitored.positive && low_value != 0 ? low_value : before;
  const double at_high = value_of(monitored, high, there.y) - hidden;
  if (at_high == 0 || (at_high > 0) == monitored.positive) return high;
  Change change{low, high, at_low, at_high};
  narrow(value, on_interpolant, change);
  std::map<double, double> known{{change.low, change.at_low}, {change.high, change.at_high}};
  const auto remembered = [&](double x) { return known[x] = value(x); };
  const integration::Bracket bracket =
      integration::bracketed_root(remembered, change.low, change.high, change.at_low, change.at_high);
  return std::abs(known[bracket.low]) < std::abs(known[bracket.high]) ? bracket.low : bracket.high;
}

}  // namespace hybrid_sphere::mechanics
