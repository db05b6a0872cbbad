#include "hybrid_sphere/mechanics/solution.hpp"

#include <algorithm>

#include "mechanics/record.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {

const char* to_string(Stop stop) {
  switch (stop) {
    case Stop::reached_end: return "reached_end";
    case Stop::singular: return "singular";
    case Stop::no_direction: return "no_direction";
    case Stop::inconsistent: return "contradiction";
    case Stop::no_velocity: return "no_velocity";
    case Stop::painleve: return "painleve";
    case Stop::livelock: return "livelock";
    case Stop::accumulation: return "accumulation";
    case Stop::too_many_switches: return "too_many_switches";
    case Stop::too_many_steps: return "too_many_steps";
    case Stop::cancelled: return "cancelled";
    case Stop::not_finite: return "not_finite";
    case Stop::undefined: return "undefined";
    case Stop::no_step: return "no_step";
  }
  return "";
}

Solution::Solution(std::unique_ptr<Record> record) : record_(std::move(record)) {}
Solution::~Solution() = default;
Solution::Solution(Solution&&) noexcept = default;
Solution& Solution::operator=(Solution&&) noexcept = default;

State Solution::at(double time) const {
  if (!(begin() <= time && time <= end())) {
    throw std::out_of_range(text::refusal("t = " + text::shortest(time),
                                          text::shortest(begin()) + " to " + text::shortest(end())));
  }
  const auto later = [](double t, const Segment& segment) { return t < segment.start; };
  const auto next = std::upper_bound(record_->segments.begin(), record_->segments.end(), time, later);
  return state_of(record_->model, *(next - 1), time, record_->status, record_->precision);
}

double Solution::begin() const { return record_->segments.front().start; }
double Solution::end() const { return record_->status.time; }
const Status& Solution::status() const { return record_->status; }
const std::vector<Switch>& Solution::switches() const { return record_->switches; }
const Projection& Solution::projection() const { return record_->projection; }
double Solution::estimated_error() const { return record_->segments.back().nodes.back().error; }
std::uint64_t Solution::steps() const { return record_->effort.steps; }
std::uint64_t Solution::evaluations() const { return record_->effort.evaluations; }
double Solution::regularity() const { return record_->effort.regularity; }
double Solution::least_regular_time() const { return record_->effort.least_regular_time; }

std::vector<ConstraintReport> Solution::constraints() const {
  std::vector<ConstraintReport> reports;
  for (std::size_t i = 0; i < record_->model.constraints.size(); ++i) {
    reports.push_back({record_->model.constraints[i].name, record_->applied[i], 0});
  }
  for (const Segment& segment : record_->segments) {
    for (const std::size_t i : segment.active) reports[i].held += segment.duration();
  }
  return reports;
}

}  // namespace hybrid_sphere::mechanics
