#include "hybrid_sphere/mechanics/solve.hpp"

#include <cmath>

#include "mechanics/check_initial.hpp"
#include "mechanics/record.hpp"
#include "mechanics/time_stepper.hpp"

namespace hybrid_sphere::mechanics {
namespace {

void check_duration(double duration, double start) {
  if (!(duration == 0 || (duration >= least_time && std::isfinite(duration)))) {
    refuse("duration", duration, "0, or a number >= 1e-100");
  }
  if (duration > 0 && start + duration == start) {
    refuse("duration", duration, "more than the rounding of the initial time");
  }
}

}  // namespace

Solution solve(const Model& model, const Initial& initial, double duration, const Options& options) {
  check(model, initial, options);
  check_duration(duration, initial.time);
  check_terms(model, initial.time, initial.q, initial.v);
  auto record = std::make_unique<Solution::Record>();
  record->model = model;
  record->applied.assign(model.constraints.size(), 0);
  const double end = initial.time + duration;
  TimeStepper stepper(record->model, initial, options, {duration, end, true});
  record->status = stepper.start(initial.active);
  if (record->status.stop == Stop::reached_end) {
    record->status = stepper.advance(end, [&](const Switch& event) {
      for (const std::size_t i : event.applied) ++record->applied[i];
      record->switches.push_back(event);
    });
  }
  record->precision = stepper.precision();
  record->projection = stepper.projection();
  record->effort = stepper.effort();
  record->segments = stepper.take_segments();
  return Solution(std::move(record));
}

}  // namespace hybrid_sphere::mechanics
