// What happens within a step: guards that change their sign, constraints that lose their direction.
#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cfloat>
#include <cmath>
#include <limits>
#include <optional>

#include "integration/bracketed_root.hpp"
#include "interrupt/interrupt.hpp"
#include "mechanics/guards.hpp"
#include "mechanics/segment_impl.hpp"

namespace hybrid_sphere::mechanics {

// A constraint whose df/dv turns round within a step may have lost its direction on the way, where nothing
// says how the motion goes on; a step may pass over that place. Components of df/dv have units of their own:
// each counts relative to what it is at the ends of the step, and the direction is lost where all of them
// are.
void SegmentIntegrator::Impl::require_directions(const Node& from) {
  constexpr double turned = -0.5;  // cosine
  constexpr double lost = 1e-5;
  constexpr int bits = 24;
  const double end = segment->nodes.back().x;
  for (Index row = 0; row < gradient.rows(); ++row) {
    const auto before = gradient_before.row(row).array();
    const auto after = gradient.row(row).array();
    const Eigen::ArrayXd sizes = before.abs().max(after.abs()).max(DBL_MIN);
    const Eigen::ArrayXd a = before.transpose() / sizes;
    const Eigen::ArrayXd b = after.transpose() / sizes;
    if ((a * b).sum() > turned * std::sqrt(a.square().sum() * b.square().sum())) continue;
    const auto largest = [&](double x) {
      motion_step.interpolate(x, interpolated);
      q = interpolated.head(q.size());
      v = interpolated.segment(q.size(), v.size());
      motion.evaluate_stage(segment->start + x, q, v);
      return (motion.gradient().row(row).array().abs().transpose() / sizes).maxCoeff();
    };
    const auto [x, least] = boost::math::tools::brent_find_minima(largest, from.x, end, bits);
    if (least > lost) continue;
    segment->nodes.pop_back();
    throw ConstraintError(ConstraintError::Reason::no_direction,
                          "constraint " + model.constraints[motion.owner(row)].name +
                              " has no direction: df/dv = 0 near " +
                              describe(model, segment->start + x, q, v));
  }
}

bool SegmentIntegrator::Impl::changed(const MonitoredGuard& monitored, const Node& node) {
  const Vector sizes = sizes_at(node);
  const int sign = sign_of(guard_of(monitored), segment->start + node.x, node.y.head(q.size()), sizes);
  return monitored.positive ? sign < 0 : sign > 0;
}

// Those of an interpolant that is less accurate than the steps: they only tell where to look.
std::vector<double> SegmentIntegrator::Impl::places_to_check(const Node& from, const Node& reached) {
  std::vector<double> places;
  for (Index i = 0; i < monitored(); ++i) {
    const auto sample = [&](double x) {
      motion_step.interpolate(x, interpolated);
      return sample_guard(i, x, interpolated);
    };
    search_guard(sample, sample_guard(i, from.x, from.y), sample_guard(i, reached.x, reached.y), places);
  }
  std::sort(places.begin(), places.end());
  places.push_back(reached.x);
  return places;
}

GuardSample SegmentIntegrator::Impl::sample_guard(Index i, double x, const Vector& state) {
  const double t = segment->start + x;
  q = state.head(q.size());
  v = state.segment(q.size(), v.size());
  model.equations->rate(q, v, q_rate);
  return {x, value_of(i, t), guard(i).rate(t, q, q_rate)};
}

std::optional<Node> SegmentIntegrator::Impl::first_change(const Node& from, const Node& reached) {
  if (guards.empty()) return std::nullopt;
  constexpr std::uint32_t turns_of_a_step = 16;
  double low = from.x;
  for (const double place : places_to_check(from, reached)) {
    if (!(place > low)) continue;
    interruption_point(turns_of_a_step);
    const Node there = place == reached.x ? reached : motion_step.reach(segment->start, from, place);
    double first = std::numeric_limits<double>::infinity();
    for (const MonitoredGuard& monitored : guards) {
      if (changed(monitored, there)) first = std::min(first, instant_of_change(monitored, from, low, place));
    }
    if (first <= place) return motion_step.reach(segment->start, from, first);
    // Beyond a root by less than rounding, it is before this place.
    const bool is_before = std::none_of(guards.begin(), guards.end(), [&](const MonitoredGuard& monitored) {
      return (guard_of(monitored).value(segment->start + place, there.y.head(q.size())) > 0) !=
             monitored.positive;
    });
    if (is_before) low = place;
  }
  return std::nullopt;
}

double SegmentIntegrator::Impl::instant_of_change(const MonitoredGuard& monitored, const Node& from,
                                                  double low, double high) {
  const Guard& guard = guard_of(monitored);
  const auto value = [&](double x) {
    const Node there = motion_step.reach(segment->start, from, x);
    return guard.value(segment->start + x, there.y.head(q.size()));
  };
  // At low the guard has not changed: what its value says otherwise is rounding.
  const double before = monitored.positive ? DBL_MIN : -DBL_MIN;
  const double low_value = value(low);
  const double at_low = (low_value > 0) == monitored.positive && low_value != 0 ? low_value : before;
  const double at_high = value(high);
  if (at_high == 0 || (at_high > 0) == monitored.positive) return high;
  const integration::Bracket bracket = integration::bracketed_root(value, low, high, at_low, at_high);
  return std::abs(value(bracket.low)) < std::abs(value(bracket.high)) ? bracket.low : bracket.high;
}

}  // namespace hybrid_sphere::mechanics
