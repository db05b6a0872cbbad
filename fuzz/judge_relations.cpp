#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <ctime>
#include <optional>
#include <sstream>
#include <variant>
#include <vector>

#include "judges.hpp"
#include "scene/tree.hpp"
#include "sphere/constants.hpp"
#include "support/place.hpp"
#include "support/random_scenes.hpp"
#include "support/recorded.hpp"
#include "support/transformed.hpp"

namespace hybrid_sphere::fuzz {
namespace {

using scene::Law;
using testing::Record;
using testing::RecordedState;

constexpr int outputs = 16;
constexpr double shift = 1e-9;
constexpr double rounding = 64 * DBL_EPSILON;  // of a place

struct Broken {
  const char* claim;
  std::string words;
};
using Found = std::optional<Broken>;

std::string at(double time, double error, double allowed) {
  std::ostringstream text;
  text.precision(17);
  text << "at t = " << time << " off by " << error << " m, allowed " << allowed;
  return text.str();
}

template <class Predicate>
bool any_ground(const scene::Surface& surface, const Predicate& predicate) {
  return predicate(surface.base) ||
         std::any_of(surface.regions.begin(), surface.regions.end(),
                     [&](const auto& region) { return predicate(region.material); });
}

/// The run, and how far neighbouring scenes come off it: what hangs on less says nothing.
struct Plain {
  const Case& a_case;
  Record record;
  std::array<Record, 2> beside;
};

/// A little faster and steeper, or slower and less steep: forces that balance do so in neither.
scene::Scene neighbour(scene::Scene scene, double part) {
  scene.initial_state.velocity *= 1 + part;
  scene.initial_state.angular_velocity *= 1 - part;
  scene.forces.gravity.head<2>() *= 1 + part;
  scene.forces.spring.stiffness *= 1 - part;
  return scene;
}

bool same_switches(const Record& a, const Record& b) {
  return a.halt.empty() == b.halt.empty() && a.switches.size() == b.switches.size() &&
         std::equal(a.switches.begin(), a.switches.end(), b.switches.begin(),
                    [](const auto& x, const auto& y) { return x.to == y.to && x.kind == y.kind; });
}

/// Whether a run goes through a region in so little time that rounding may take both edges for one: the
/// instants of a curved path whose error bounds overlap are one.
bool passes_in_no_time(const Record& record) {
  constexpr double little = 0x1p-40;
  for (std::size_t i = 0; i + 1 < record.switches.size(); ++i) {
    const auto& entered = record.switches[i];
    const auto& left = record.switches[i + 1];
    const double stay = left.time - entered.time;
    if (left.from == entered.to && left.to == entered.from && stay > 0 && stay < little * (1 + left.time))
      return true;
  }
  return false;
}

double way_of(const Record& record) {
  double way = 0;
  for (std::size_t i = 1; i < record.states.size(); ++i) {
    const double step = record.states[i].time - record.states[i - 1].time;
    way += std::max((record.states[i].position - record.states[i - 1].position).norm(),
                    step * record.states[i].twist.velocity.norm());
  }
  return way;
}

/// Compares places with those that follow from the plain run.
template <class Place>
Found compare(const Plain& plain, const Record& other, const char* claim, const Place& place,
              double extra = 0) {
  for (const Record& beside : plain.beside) {
    if (plain.record.halt.empty() != beside.halt.empty()) return {};
  }
  const double way = way_of(plain.record);
  const scene::Solver& solver = plain.a_case.scene.solver;
  const double accuracy =
      solver.has_fixed_step() ? 1e-3 : std::max(solver.accuracy, plain.record.estimated_error);
  for (std::size_t i = 0; i < plain.record.states.size(); ++i) {
    const RecordedState& state = plain.record.states[i];
    double spread = 0;
    for (const Record& beside : plain.beside) {
      if (i >= beside.states.size()) return {};
      spread = std::max(spread, (beside.states[i].position - state.position).norm());
    }
    const double allowed = (1e-8 + 1e2 * accuracy) * way + 100 * std::max(1.0, accuracy / shift) * spread +
                           rounding * state.position.norm() + extra;
    if (allowed > 1e-2 * way) return {};
    const bool halts = i >= other.states.size();
    // Both halt about an output.
    if (i == other.states.size() && !plain.record.halt.empty() && i + 1 == plain.record.states.size()) break;
    const double error = halts ? never : (other.states[i].position - place(state)).norm();
    // How many of the throws that accumulate are told apart, and with that when both halt, is rounding.
    const double later = halts ? 0 : std::abs(other.states[i].time - state.time);
    if (error <= allowed + later * state.twist.velocity.norm()) continue;
    if (passes_in_no_time(plain.record) != passes_in_no_time(other)) return {};
    return Broken{claim, halts ? "the other halts: " + other.halt : at(state.time, error, allowed)};
  }
  return {};
}

/// Interrupted after so long [s of processor time].
Record run_for(double seconds, const scene::Scene& scene, double duration) {
  return testing::record(scene, duration, outputs, [begin = std::clock(), seconds] {
    return static_cast<double>(std::clock() - begin) > seconds * CLOCKS_PER_SEC;
  });
}

// What is related to a run takes as long as that, or a little longer.
constexpr double patience = 2;
Record run(const scene::Scene& scene, double duration) { return run_for(4 * patience, scene, duration); }

Plain plain_run(const Case& a_case, double seconds) {
  const auto record = [&](const scene::Scene& scene) { return run_for(seconds, scene, a_case.duration); };
  return {a_case,
          record(a_case.scene),
          {record(neighbour(a_case.scene, shift)), record(neighbour(a_case.scene, -shift))}};
}

Found symmetric(const Plain& plain, const testing::Symmetry& symmetry, const char* claim) {
  const Record moved = run(symmetry.of(plain.a_case.scene), plain.a_case.duration);
  return compare(plain, moved, claim,
                 [&](const RecordedState& state) { return symmetry.of(state.position); });
}

bool same_places(const scene::Scene& a, const scene::Scene& b) {
  const auto corners = [](const scene::Shape& shape) {
    if (const auto* half_plane = std::get_if<scene::HalfPlane>(&shape))
      return std::vector<Vector2d>{half_plane->point};
    if (const auto* circle = std::get_if<scene::Circle>(&shape)) return std::vector<Vector2d>{circle->center};
    return std::get<scene::Polygon>(shape).vertices;
  };
  const auto same = [&](const scene::Region& x, const scene::Region& y) {
    return corners(x.shape) == corners(y.shape) && x.material.turntable_center == y.material.turntable_center;
  };
  return a.initial_state.position == b.initial_state.position &&
         a.forces.spring.center == b.forces.spring.center &&
         a.surface.base.turntable_center == b.surface.base.turntable_center &&
         std::equal(a.surface.regions.begin(), a.surface.regions.end(), b.surface.regions.begin(), same);
}

// Where the shift rounds nothing: places on an edge stay on it. A motion that is less than the rounding of
// the places there is none.
Found elsewhere(const Plain& plain) {
  const scene::Scene& scene = plain.a_case.scene;
  const Vector2d way(-4, 8);
  const scene::InitialState& start = scene.initial_state;
  const double speed = start.velocity.norm() + scene.sphere.radius * start.angular_velocity.head<2>().norm();
  if (speed > 0 && speed * plain.a_case.duration < rounding * way.norm()) return {};
  const scene::Scene moved = testing::shifted(scene, way);
  if (!same_places(testing::shifted(moved, -way), scene)) return {};
  return compare(
      plain, run(moved, plain.a_case.duration), "elsewhere the same",
      [&](const RecordedState& state) { return Vector2d(state.position + way); }, rounding * way.norm());
}

/// From the edge of a region and from the lines of its sides [m].
double distance_to_lines(const scene::Shape& shape, const Vector2d& point) {
  double distance = testing::distance_to_edge(shape, point);
  if (const auto* polygon = std::get_if<scene::Polygon>(&shape)) {
    const std::vector<Vector2d>& corners = polygon->vertices;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vector2d& from = corners[i];
      const Vector2d normal = turned((corners[i + 1 < corners.size() ? i + 1 : 0] - from).normalized());
      distance = std::min(distance, std::abs(normal.dot(point - from)));
    }
  }
  return distance;
}

/// Not on it, but within rounding of it: that is left a time sqrt(2 r/a) later, at a speed of sqrt(2 r a).
bool starts_beside_an_edge(const Plain& plain) {
  const scene::Scene& scene = plain.a_case.scene;
  const Vector2d& start = scene.initial_state.position;
  const double little = 1e-12 * (start.norm() + way_of(plain.record));
  return std::any_of(scene.surface.regions.begin(), scene.surface.regions.end(), [&](const auto& region) {
    const double distance = distance_to_lines(region.shape, start);
    return distance > 0 && distance <= little;
  });
}

Found by_another_method(const Plain& plain) {
  using Method = scene::Solver::Method;
  scene::Scene scene = plain.a_case.scene;
  if (scene.solver.has_fixed_step()) return {};
  scene.solver.method = scene.solver.uses_closed_forms() ? Method::dopri87 : Method::automatic;
  const Record other = run_for(patience, scene, plain.a_case.duration);
  // An explicit method takes millions of steps where a slip stays small beside a resistance.
  const bool gives_up = other.halt.find("too many steps") != std::string::npos;
  if (other.interrupted || gives_up) return {};
  const auto place = [](const RecordedState& state) { return state.position; };
  constexpr auto claim = "by another method the same";
  const double hidden = starts_beside_an_edge(plain) ? std::sqrt(rounding) * way_of(plain.record) : 0;
  const Found found = compare(plain, other, claim, place, hidden);
  if (!found) return {};
  // A path that just touches an edge meets it or not by the error of its integration.
  const bool is_integrated = !plain.a_case.scene.solver.uses_closed_forms();
  const Record& one = is_integrated ? plain.record : other;
  const Plain integrated{plain.a_case, one, {one, one}};
  scene.solver = plain.a_case.scene.solver;
  if (!is_integrated) scene.solver.method = Method::dopri87;
  scene.solver.accuracy *= scene.solver.accuracy < 1e-10 ? 16 : 0x1p-4;
  const Record again = run_for(patience, scene, plain.a_case.duration);
  if (again.interrupted || compare(integrated, again, claim, place, hidden)) return {};
  return found;
}

// Powers of two scale without rounding. Angles and powers of numbers do not.
Found in_other_units(const Plain& plain) {
  constexpr auto claim = "in other units the same to the bit";
  const scene::Scene& scene = plain.a_case.scene;
  const auto rounds = [&](const scene::Material& m) {
    return m.turntable_rate != 0 || m.law == Law::coulomb || m.rolling_resistance != 0;
  };
  const bool changes = scene.forces.drag.translational != 0 || scene.forces.drag.rotational != 0 ||
                       scene.forces.drag.quadratic != 0 || scene.forces.spring.stiffness != 0;
  if (changes || any_ground(scene.surface, rounds) || !scene.solver.uses_closed_forms()) return {};
  const testing::Units units{8, 0.25, 2};
  const Record scaled = run(testing::in_units(scene, units), plain.a_case.duration * units.time);
  if (scaled.states.size() != plain.record.states.size())
    return Broken{claim, "other outputs: " + scaled.halt};
  if (scaled.switches.size() != plain.record.switches.size()) return Broken{claim, "other switches"};
  for (std::size_t i = 0; i < scaled.states.size(); ++i) {
    const RecordedState& a = plain.record.states[i];
    const RecordedState& b = scaled.states[i];
    if (b.position != units.length * a.position || b.name != a.name || b.mode != a.mode)
      return Broken{claim, at(a.time, (b.position - units.length * a.position).norm(), 0)};
  }
  return {};
}

// Only ground without an edge looks the same to who moves with it; drag and springs do not move along.
Found from_a_moving_frame(const Plain& plain) {
  scene::Scene scene = plain.a_case.scene;
  const scene::Drag& drag = scene.forces.drag;
  scene.surface.regions.clear();
  if (drag.translational != 0 || drag.quadratic != 0 || scene.forces.spring.stiffness != 0 ||
      scene.surface.base.turntable_rate != 0)
    return {};
  const double span = plain.a_case.duration;
  const Case alone{scene, span};
  const Plain still = plain_run(alone, 4 * patience);
  // As fast as the motion itself, whatever its units are.
  const double speed = scene.initial_state.velocity.norm() + way_of(still.record) / span;
  const Vector2d velocity = (speed > 0 ? std::ldexp(1.0, std::ilogb(speed)) : 1) * Vector2d(1, -0.5);
  scene.initial_state.velocity += velocity;
  if (scene.surface.base.law != Law::smooth) scene.surface.base.belt += velocity;
  const Record moving = run(scene, span);
  return compare(
      still, moving, "from a frame that moves with the ground the same",
      [&](const RecordedState& state) { return Vector2d(state.position + state.time * velocity); },
      1e-9 * velocity.norm() * span);
}

/// On which side of an edge or of a corner a path is that runs along it, or into it, is lost with the
/// rounding of the place where it begins.
/// @param rest  the run that begins there
bool hangs_on_rounding(const Plain& plain, const scene::Scene& scene, const Record& rest, double span) {
  const Vector2d& start = scene.initial_state.position;
  const double little = 1e-12 * (start.norm() + way_of(plain.record));
  for (const scene::Region& region : scene.surface.regions) {
    if (distance_to_lines(region.shape, start) <= little) return true;
  }
  for (const double side : {-1.0, 1.0}) {
    scene::Scene beside = scene;
    beside.initial_state.position += side * little * turned(scene.initial_state.velocity).normalized();
    if (!same_switches(rest, testing::record(beside, span, outputs / 2))) return true;
  }
  return false;
}

// Velocities of a state are those after its last switch: a sphere that is put there goes on likewise.
Found begun_anew(const Plain& plain) {
  const std::size_t half = outputs / 2;
  const Record& whole = plain.record;
  if (whole.states.size() != outputs + 1 || whole.states[half].mode == Mode::edge_sliding) return {};
  const RecordedState& there = whole.states[half];
  if (there.mode == Mode::resting) return {};
  for (const auto& event : whole.switches) {
    if (std::abs(event.time - there.time) <= 1e-6 * plain.a_case.duration) return {};
  }
  scene::Scene scene = plain.a_case.scene;
  scene.initial_state = {there.position, there.orientation, there.twist.velocity,
                         there.twist.angular_velocity};
  const Record rest =
      testing::record(scene, plain.a_case.duration - there.time, outputs - static_cast<int>(half));
  Record joined = whole;
  for (std::size_t i = half; i < joined.states.size() && i - half < rest.states.size(); ++i)
    joined.states[i] = rest.states[i - half];
  joined.switches.insert(joined.switches.end(), rest.switches.begin(), rest.switches.end());
  if (!rest.halt.empty() && whole.halt.empty()) return {};
  const Found found = compare(plain, joined, "a run that begins anew on its way goes on likewise",
                              [](const RecordedState& state) { return state.position; });
  if (found && hangs_on_rounding(plain, scene, rest, plain.a_case.duration - there.time)) return {};
  return found;
}

// Forces that have a potential, on smooth ground.
Found backwards(const Plain& plain) {
  scene::Scene scene = plain.a_case.scene;
  scene.surface.regions.clear();
  scene.surface.base = Law::smooth;
  scene.forces.drag = {};
  scene.forces.wrench.torque.setZero();
  const double span = plain.a_case.duration;
  const Case alone{scene, span};
  const Plain there = plain_run(alone, 4 * patience);
  const RecordedState& last = there.record.states.back();
  if (!there.record.halt.empty()) return {};
  scene.initial_state = {last.position, last.orientation, -last.twist.velocity, -last.twist.angular_velocity};
  Record back = run(scene, span);
  std::reverse(back.states.begin(), back.states.end());
  return compare(there, back, "on smooth ground time runs backwards, too",
                 [](const RecordedState& state) { return state.position; });
}

}  // namespace

Verdict judge_relations(const Case& a_case) {
  try {
    const Case read{read_back(a_case.scene), a_case.duration};
    const Plain plain = plain_run(read, patience);
    // What a run may cost is judged by the invariants.
    if (plain.record.interrupted || plain.beside[0].interrupted || plain.beside[1].interrupted)
      return {Verdict::Kind::skipped, "it takes too long to be run again and again", ""};
    for (const Found& found : {symmetric(plain, testing::mirror(), "in a mirror the same"),
                               symmetric(plain, testing::quarter_turn(), "turned by a right angle the same"),
                               elsewhere(plain), by_another_method(plain), in_other_units(plain),
                               from_a_moving_frame(plain), begun_anew(plain), backwards(plain)}) {
      if (found) return {Verdict::Kind::found, found->claim, found->words};
    }
    if (!plain.record.halt.empty()) return {Verdict::Kind::halted, reason_alone(plain.record.halt), ""};
    return {};
  } catch (const scene::SceneError& error) {
    return {Verdict::Kind::refused, reason_alone(error.what()), ""};
  } catch (const std::invalid_argument& error) {
    return {Verdict::Kind::refused, reason_alone(error.what()), ""};
  }
}

}  // namespace hybrid_sphere::fuzz
