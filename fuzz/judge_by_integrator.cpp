#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "compared_runs.hpp"
#include "judges.hpp"
#include "own_integrator.hpp"
#include "scene/tree.hpp"
#include "simulation/constraint.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::fuzz {
namespace {

using own::OwnRun;
using own::Real;
using testing::Record;
using testing::RecordedState;

constexpr int outputs = 8;

Verdict skipped(const std::string& why) { return {Verdict::Kind::skipped, why, ""}; }

double distance(const own::Vec4& a, const own::Vec4& b) {
  return static_cast<double>(std::min((a - b).norm(), (a + b).norm()));
}

/// How far two runs are apart at an output, each in its own unit.
struct Apart {
  double place = 0;     // [m]
  double velocity = 0;  // [m/s]
  double spin = 0;      // times the radius [m/s]
  double attitude = 0;
};

Apart apart(const own::Body& a, const own::Body& b, double radius) {
  return {static_cast<double>((a.r - b.r).norm()), static_cast<double>((a.v - b.v).norm()),
          radius * static_cast<double>((a.w - b.w).norm()), distance(a.q, b.q)};
}

own::Body body_of(const RecordedState& state) {
  return {state.position.cast<Real>(), state.twist.velocity.cast<Real>(),
          state.twist.angular_velocity.cast<Real>(), state.orientation.coeffs().cast<Real>()};
}

/// The reference, what its neighbours do and what shorter steps change.
struct Reference {
  OwnRun run;
  OwnRun above;
  OwnRun below;
  OwnRun halved;
};

/// Whether a run has a switch so near to an output that the output may be before or after it.
template <class Run>
bool near_switch(const Run& run, double time, double span) {
  return std::any_of(run.switches.begin(), run.switches.end(), [&](const auto& event) {
    return time > 0 && std::abs(static_cast<double>(event.time) - time) <= 1e-5 * span;
  });
}

/// Instants at which throws to and fro have become short and shorter: those that come after them until the
/// last one, by section 5.5 of docs/theory.md, are as many as somebody resolves.
template <class Run>
void add_last_throws(const Run& run, double span, std::vector<double>& instants) {
  const auto& events = run.switches;
  for (std::size_t i = 4; i < events.size(); ++i) {
    const auto last = static_cast<double>(events[i].time - events[i - 2].time);
    const auto before = static_cast<double>(events[i - 2].time - events[i - 4].time);
    const bool to_and_fro = events[i].to == events[i - 2].to && events[i - 2].to == events[i - 4].to;
    if (to_and_fro && last < before && last <= 1e-6 * span)
      instants.push_back(static_cast<double>(events[i].time));
  }
}

/// Whether the throws that the integrator leaves out, which are too short for it, would take what can be
/// seen: the rest of a geometric series whose ratio is near 1.
bool leaves_out_throws(const OwnRun& run, double span) {
  const auto& events = run.switches;
  const auto throw_to = [&](std::size_t i) {
    const bool to_and_fro = i >= 2 && i < events.size() && events[i].to == events[i - 2].to;
    return to_and_fro ? static_cast<double>(events[i].time - events[i - 2].time) : 0;
  };
  for (std::size_t i = 4; i < events.size(); ++i) {
    const double last = throw_to(i), before = throw_to(i - 2), next = throw_to(i + 2);
    const bool is_end = last > 0 && last < before && (next == 0 || next > last);
    if (is_end && last * last > 1e-9 * span * (before - last)) return true;
  }
  return false;
}

/// Whether the last throws of the integrator before an instant are to and fro, next to it, and come ever
/// sooner as far as they have a past.
bool accumulates_at(double instant, const OwnRun& run, double span) {
  constexpr double next_to = 1e-3;  // of the run
  const auto& events = run.switches;
  const auto time = [&](std::size_t i) { return static_cast<double>(events[i].time); };
  std::size_t last = events.size();
  while (last > 0 && time(last - 1) > instant + 1e-5 * span) --last;
  if (last < 3 || events[last - 1].to != events[last - 3].to) return false;
  const double interval = time(last - 1) - time(last - 3);
  if (interval > next_to * span || instant - time(last - 1) > next_to * span) return false;
  return last < 5 || events[last - 5].to != events[last - 1].to || interval < time(last - 3) - time(last - 5);
}

/// Whether a slip is used up just where its ground ends: there or beyond, as rounding has it, and again at
/// each return.
bool ends_slip_on_edge(const Record& record, double span) {
  const auto& events = record.switches;
  for (std::size_t i = 0; i + 1 < events.size(); ++i) {
    const bool used_up = events[i].kind == SwitchKind::applied && events[i].impulse.isZero(0);
    const bool at_once = events[i + 1].time - events[i].time <= 1e-10 * span;
    if (used_up && at_once && events[i + 1].kind == SwitchKind::released) return true;
  }
  return false;
}

/// The first of the grounds that are as the named one: in a corner of two regions of one ground both names
/// hold.
std::string first_like(const scene::Surface& surface, const std::string& name) {
  const auto named = std::find_if(surface.regions.begin(), surface.regions.end(),
                                  [&](const scene::Region& region) { return region.name == name; });
  if (named == surface.regions.end() || same_ground(named->material, surface.base)) return "base";
  const auto first = std::find_if(surface.regions.begin(), named, [&](const scene::Region& region) {
    return same_ground(region.material, named->material);
  });
  return first->name;
}

/// The grounds of the switches that can be told: not those about the end of the run, nor the last throws of
/// those that accumulate.
/// @param all  also two on one ground at one instant, where forces that just balance let the sphere slip for
///             no time, and those into a sliver and out of it within 2^-40 of the time, which a curved path
///             need not see
template <class Run>
std::vector<std::string> told(const scene::Surface& surface, const Run& run,
                              const std::vector<double>& last_throws, double span, bool all) {
  std::vector<std::string> result;
  double last = -span;
  for (const auto& event : run.switches) {
    const auto time = static_cast<double>(event.time);
    const bool is_last_throw = std::any_of(last_throws.begin(), last_throws.end(), [&](double instant) {
      return std::abs(instant - time) <= 2e-6 * span;
    });
    if (time > (1 - 1e-5) * span || is_last_throw) continue;
    const std::string ground = first_like(surface, event.to);
    const std::size_t known = result.size();
    // What exceeds friction by rounding lasts for the root of that.
    const bool slips_for_no_time = !all && time - last <= 1e-7 * span && result.back() == ground;
    const bool passes_sliver =
        !all && time - last <= 0x1p-40 * span && known > 1 && result[known - 2] == ground;
    if (slips_for_no_time) {
      result.pop_back();
      const bool enters = result.empty() || result.back() != ground;
      if (enters) result.push_back(ground);
      last = enters ? time : -span;
    } else if (passes_sliver) {
      result.pop_back();
      last = -span;
    } else {
      result.push_back(ground);
      last = time;
    }
  }
  return result;
}

/// How many grounds a run passes through in less than 2^-40 of the time, but in some.
template <class Run>
std::size_t passed_slivers(const Run& run, double span) {
  std::size_t count = 0;
  double last = -span;
  for (const auto& event : run.switches) {
    const auto time = static_cast<double>(event.time);
    if (time > last && time - last <= 0x1p-40 * span) ++count;
    last = time;
  }
  return count;
}

std::string words(const char* what, double time, double error, double allowed) {
  std::ostringstream text;
  text.precision(9);
  text << "at t = " << time << " " << what << " is off by " << error << ", allowed " << allowed;
  return text.str();
}

std::string list(const Record& record) {
  std::ostringstream text;
  for (const auto& event : record.switches) text << event.time << " -> " << event.to << ", ";
  return text.str().substr(0, 300);
}

std::string list(const OwnRun& run) {
  std::ostringstream text;
  for (const auto& event : run.switches)
    text << static_cast<double>(event.time) << " -> " << event.to << ", ";
  return text.str().substr(0, 300);
}

/// Of a method that was asked for; then `auto` has to come to the end.
bool takes_too_many_steps(const scene::Scene& scene, const Record& record) {
  return record.halt.find("too many steps") != std::string::npos && !scene.solver.uses_closed_forms();
}

class Comparison {
 public:
  Comparison(const scene::Scene& scene, const Reference& reference, const std::vector<double>& times)
      : scene_(scene), reference_(reference), times_(times), span_(times.back()) {}

  Verdict judge(const Record& record) const {
    const Verdict verdict = judge_all(record);
    if (verdict.kind == Verdict::Kind::found && leaves_out_throws(reference_.run, span_))
      return skipped("the throws that the integrator leaves out take what can be seen");
    const bool one_passes_sliver = passed_slivers(record, span_) != passed_slivers(reference_.run, span_);
    return verdict.kind == Verdict::Kind::found && one_passes_sliver
               ? skipped("one of them passes through a sliver that rounding hides")
               : verdict;
  }

 private:
  Verdict judge_all(const Record& record) const {
    const OwnRun& run = reference_.run;
    // The last state of a run that has halted is that of the halt.
    const std::size_t known = record.states.size() - (record.halt.empty() ? 0 : 1);
    // At 0 itself the integrator has not followed all that happens there.
    for (std::size_t i = 1; i < run.states.size(); ++i) {
      if (i >= known) break;
      if (near_switch(run, times_[i], span_) || near_switch(record, times_[i], span_)) continue;
      const Verdict verdict = judge_state(i, record.states[i]);
      if (verdict.kind != Verdict::Kind::held) return verdict;
    }
    if (!record.halt.empty()) return judge_halt(record);
    std::vector<double> last_throws;
    add_last_throws(run, span_, last_throws);
    add_last_throws(record, span_, last_throws);
    if (same_grounds(record, last_throws, true) || same_grounds(record, last_throws, false)) return {};
    return {Verdict::Kind::found, "the switches are those of the independent integrator",
            list(record) + "instead of " + list(run)};
  }

  bool same_grounds(const Record& record, const std::vector<double>& last_throws, bool all) const {
    return told(scene_.surface, reference_.run, last_throws, span_, all) ==
           told(scene_.surface, record, last_throws, span_, all);
  }

  Verdict judge_halt(const Record& record) const {
    if (takes_too_many_steps(scene_, record)) return {};
    const auto says = [&](const char* word) { return record.halt.find(word) != std::string::npos; };
    const bool is_backed =
        says("livelock") || says("rounding") || says("thrown") ||
        (says("accumulate") && accumulates_at(record.states.back().time, reference_.run, span_));
    if (is_backed) return skipped("halt: " + reason_alone(record.halt));
    return {Verdict::Kind::found, "no halt where the independent integrator goes on", record.halt};
  }

  Verdict judge_state(std::size_t i, const RecordedState& state) const {
    const double radius = scene_.sphere.radius;
    const own::Body& expected = reference_.run.states[i].body;
    const Apart error = apart(body_of(state), expected, radius);
    const Apart above = apart(reference_.above.states[i].body, expected, radius);
    const Apart below = apart(reference_.below.states[i].body, expected, radius);
    const Apart halved = apart(reference_.halved.states[i].body, expected, radius);
    const double speed = static_cast<double>(reference_.run.speed);
    const double scale = speed * span_;
    const double turned = 1 + static_cast<double>(expected.w.norm()) * span_;
    const Apart units{scale, speed, speed, turned};
    const struct {
      const char* what;
      double Apart::*part;
    } parts[] = {{"the place", &Apart::place},
                 {"the velocity", &Apart::velocity},
                 {"the spin", &Apart::spin},
                 {"the orientation", &Apart::attitude}};
    for (const auto& [what, part] : parts) {
      const double accuracy = std::max(1.0, scene_.solver.accuracy / shift);
      const double allowed = 1e-8 * accuracy * units.*part +
                             200 * accuracy * std::max(above.*part, below.*part) + 50 * halved.*part;
      if (allowed > 1e-3 * units.*part) return skipped("hangs on less than can be told");
      if (!(error.*part <= allowed)) {
        return {Verdict::Kind::found, "the state is that of the independent integrator",
                words(what, times_[i], error.*part, allowed)};
      }
    }
    return {};
  }

  const scene::Scene& scene_;
  const Reference& reference_;
  const std::vector<double>& times_;
  double span_;
};

bool slides_along_edge(const Record& record) {
  return std::any_of(record.states.begin(), record.states.end(),
                     [](const auto& state) { return state.mode == Mode::edge_sliding; }) ||
         std::any_of(record.switches.begin(), record.switches.end(),
                     [](const auto& event) { return event.cause == Cause::livelock; });
}

}  // namespace

Verdict judge_by_integrator(const Case& a_case) {
  scene::Scene scene;
  Record record;
  const double span = a_case.duration / 2;
  std::vector<double> times;
  for (int i = 0; i <= outputs; ++i) times.push_back(span * i / outputs);
  try {
    scene = read_back(a_case.scene);
    if (scene.solver.has_fixed_step()) scene.solver.method = scene::Solver::Method::automatic;
    if (scene.solver.accuracy > 1e-7) scene.solver.accuracy = scene::Solver().accuracy;
    record = testing::record(scene, span, outputs);
  } catch (const scene::SceneError& error) {
    return {Verdict::Kind::refused, reason_alone(error.what()), ""};
  } catch (const std::invalid_argument& error) {
    return {Verdict::Kind::refused, reason_alone(error.what()), ""};
  }
  if (is_less_than_rounding({scene, a_case.duration}, size_of_places(scene)))
    return skipped("it begins slower than places are rounded");
  if (slides_along_edge(record)) return skipped("slides along an edge");
  if (ends_slip_on_edge(record, span)) return skipped("a slip is used up just where its ground ends");
  Reference reference;
  reference.run = own::integrate(scene, times, 1);
  if (!reference.run.gave_up.empty()) return skipped("the integrator: " + reference.run.gave_up);
  reference.above = own::integrate(neighbour(scene, shift), times, 1);
  reference.below = own::integrate(neighbour(scene, -shift), times, 1);
  reference.halved = own::integrate(scene, times, 2);
  const std::array<const OwnRun*, 3> others = {&reference.above, &reference.below, &reference.halved};
  std::vector<double> last_throws;
  add_last_throws(reference.run, span, last_throws);
  for (const OwnRun* other : others) {
    if (!other->gave_up.empty()) return skipped("a neighbour of the integrator's run ends");
    add_last_throws(*other, span, last_throws);
  }
  const auto grounds = told(scene.surface, reference.run, last_throws, span, false);
  for (const OwnRun* other : others) {
    if (grounds != told(scene.surface, *other, last_throws, span, false))
      return skipped("its switches hang on less than can be told");
  }
  const Comparison comparison(scene, reference, times);
  const Verdict verdict = comparison.judge(record);
  if (verdict.kind != Verdict::Kind::held || !takes_too_many_steps(scene, record)) return verdict;
  scene::Scene other = scene;
  other.solver.method = scene::Solver::Method::automatic;
  return comparison.judge(testing::record(other, span, outputs));
}

}  // namespace hybrid_sphere::fuzz
