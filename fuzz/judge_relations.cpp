#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "compared_runs.hpp"
#include "judges.hpp"
#include "scene/tree.hpp"
#include "sphere/constants.hpp"
#include "support/random_scenes.hpp"
#include "support/transformed.hpp"

namespace hybrid_sphere::fuzz {
namespace {

using scene::Law;
using testing::Record;
using testing::RecordedState;

template <class Predicate>
bool any_ground(const scene::Surface& surface, const Predicate& predicate) {
  return predicate(surface.base) ||
         std::any_of(surface.regions.begin(), surface.regions.end(),
                     [&](const auto& region) { return predicate(region.material); });
}

/// Whether a scene halts, and so do its neighbours: what no neighbour shares says nothing.
bool halts_for_certain(const Plain& plain, const scene::Scene& scene, const Record& record) {
  const double duration = plain.a_case.duration;
  // What comes after throws that end in a corner hangs on how many are told apart.
  if (record.halt.empty() || accumulates_before(record.states.back().time, plain.record, duration))
    return false;
  return !run(neighbour(scene, shift), duration).halt.empty() &&
         !run(neighbour(scene, -shift), duration).halt.empty();
}

/// The run of a scene that is related to the plain one.
Found related(const Plain& plain, const scene::Scene& scene, const char* claim, const Place& place,
              double extra = 0) {
  const Record other = run(scene, plain.a_case.duration);
  const Found found = compare(plain, other, claim, place, extra);
  const bool says_nothing = found && !other.halt.empty() && !halts_for_certain(plain, scene, other);
  return says_nothing ? Found() : found;
}

Found symmetric(const Plain& plain, const testing::Symmetry& symmetry, const char* claim) {
  return related(plain, symmetry.of(plain.a_case.scene), claim,
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

// Where the shift rounds nothing: places on an edge stay on it.
Found elsewhere(const Plain& plain) {
  const scene::Scene& scene = plain.a_case.scene;
  const Vector2d way(-4, 8);
  const scene::Scene moved = testing::shifted(scene, way);
  if (!same_places(testing::shifted(moved, -way), scene) || is_less_than_rounding(plain.a_case, way.norm()))
    return {};
  return related(
      plain, moved, "elsewhere the same",
      [&](const RecordedState& state) { return Vector2d(state.position + way); },
      rounding * way.norm() + way_hidden_by_rounding(plain));
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
  if (is_less_than_rounding(plain.a_case, size_of_places(scene))) return {};
  const double hidden = way_hidden_by_rounding(plain);
  const Found found = compare(plain, other, claim, place, hidden);
  if (!found || (!other.halt.empty() && !halts_for_certain(plain, scene, other))) return {};
  // A path that just touches an edge meets it or not by the error of its integration.
  const bool is_integrated = !plain.a_case.scene.solver.uses_closed_forms();
  const Record& one = is_integrated ? plain.record : other;
  const Plain integrated{plain.a_case, one, {one, one}};
  scene.solver = plain.a_case.scene.solver;
  if (!is_integrated) scene.solver.method = Method::dopri87;
  const double accuracy = scene.solver.accuracy;
  for (const double part : {0x1p-4, 0x1p4, 0x1p-10, 0.0}) {
    scene.solver.accuracy = std::max(1e-13, part * accuracy);
    const Record again = run_for(patience, scene, plain.a_case.duration);
    if (again.interrupted || compare(integrated, again, claim, place, hidden)) return {};
  }
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
    return Broken{claim, "other compared_outputs: " + scaled.halt};
  if (scaled.switches.size() != plain.record.switches.size()) return Broken{claim, "other switches"};
  for (std::size_t i = 0; i < scaled.states.size(); ++i) {
    const RecordedState& a = plain.record.states[i];
    const RecordedState& b = scaled.states[i];
    if (b.position != units.length * a.position || b.name != a.name || b.mode != a.mode)
      return Broken{claim, off_at(a.time, (b.position - units.length * a.position).norm(), 0)};
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
    if (!same_switches(rest, testing::record(beside, span, compared_outputs / 2))) return true;
  }
  return false;
}

// Velocities of a state are those after its last switch: a sphere that is put there goes on likewise.
Found begun_anew(const Plain& plain) {
  const std::size_t half = compared_outputs / 2;
  const Record& whole = plain.record;
  if (whole.states.size() != compared_outputs + 1 || whole.states[half].mode == Mode::edge_sliding) return {};
  const RecordedState& there = whole.states[half];
  if (there.mode == Mode::resting) return {};
  for (const auto& event : whole.switches) {
    if (std::abs(event.time - there.time) <= 1e-6 * plain.a_case.duration) return {};
  }
  scene::Scene scene = plain.a_case.scene;
  scene.initial_state = {there.position, there.orientation, there.twist.velocity,
                         there.twist.angular_velocity};
  const Record rest =
      testing::record(scene, plain.a_case.duration - there.time, compared_outputs - static_cast<int>(half));
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
    if (is_lost_on_an_edge(read.scene))
      return {Verdict::Kind::skipped, "it begins on an edge, slower than places are rounded", ""};
    const Plain plain = plain_run(read, patience);
    // What a run may cost is judged by the invariants.
    if (plain.record.interrupted || plain.beside[0].interrupted || plain.beside[1].interrupted)
      return {Verdict::Kind::skipped, "it takes too long to be run again and again", ""};
    if (stands_on_an_edge(plain))
      return {Verdict::Kind::skipped, "it stands on an edge when it switches", ""};
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
