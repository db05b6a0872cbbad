#include <algorithm>
#include <cmath>
#include <iomanip>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "pace.hpp"
#include "scene/tree.hpp"
#include "sphere/dynamics.hpp"
#include "support/place.hpp"
#include "support/recorded.hpp"
#include "verdict.hpp"

namespace hybrid_sphere::fuzz {
namespace {

using scene::Law;
using testing::Record;
using testing::RecordedState;
using testing::RecordedSwitch;

constexpr double unit = 0x1p-53;

/// What does not hold: a claim, and where.
struct Broken {
  const char* claim;
  std::string words;
};
using Found = std::optional<Broken>;

std::string at(double time) {
  std::ostringstream words;
  words << std::setprecision(17) << "at t = " << time;
  return words.str();
}

std::string number(double value) {
  std::ostringstream words;
  words << value;
  return words.str();
}

bool equal(const RecordedState& a, const RecordedState& b) {
  return a.time == b.time && a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs() &&
         a.twist.velocity == b.twist.velocity && a.twist.angular_velocity == b.twist.angular_velocity &&
         a.slip == b.slip && a.stage == b.stage && a.mode == b.mode && a.name == b.name &&
         a.reaction == b.reaction;
}

bool equal(const RecordedSwitch& a, const RecordedSwitch& b) {
  return a.index == b.index && a.time == b.time && a.time_remainder == b.time_remainder && a.kind == b.kind &&
         a.cause == b.cause && a.from == b.from && a.to == b.to && a.position == b.position &&
         a.impulse == b.impulse && a.angular_impulse == b.angular_impulse &&
         a.after.velocity == b.after.velocity && a.after.angular_velocity == b.after.angular_velocity;
}

Found same_at_any_rate(const Record& coarse, const Record& fine) {
  constexpr auto claim = "one output and two hundred give the same to the bit";
  if (coarse.halt != fine.halt) return Broken{claim, "one halts: " + coarse.halt + " / " + fine.halt};
  if (coarse.switches.size() != fine.switches.size()) {
    return Broken{claim, number(static_cast<double>(coarse.switches.size())) + " switches with one, " +
                             number(static_cast<double>(fine.switches.size())) + " with two hundred"};
  }
  for (std::size_t i = 0; i < coarse.switches.size(); ++i) {
    if (!equal(coarse.switches[i], fine.switches[i]))
      return Broken{claim, "switch " + at(coarse.switches[i].time)};
  }
  if (!equal(coarse.states.back(), fine.states.back())) return Broken{claim, "the last state"};
  return {};
}

Found finite(const RecordedState& state) {
  if (!(std::isfinite(state.time) && state.position.allFinite() && state.orientation.coeffs().allFinite() &&
        state.twist.velocity.allFinite() && state.twist.angular_velocity.allFinite() &&
        state.slip.allFinite() && state.reaction.allFinite()))
    return Broken{"every number of a state is finite", at(state.time)};
  if (std::abs(state.orientation.norm() - 1) > 64 * unit) {
    return Broken{"the orientation is a unit quaternion",
                  at(state.time) + ", off by " + number(state.orientation.norm() - 1)};
  }
  return {};
}

Found finite(const RecordedSwitch& event) {
  const bool is_finite = std::isfinite(event.time) && std::isfinite(event.time_remainder) &&
                         event.position.allFinite() && event.slip_before.allFinite() &&
                         event.impulse.allFinite() && event.angular_impulse.allFinite() &&
                         event.before.velocity.allFinite() && event.before.angular_velocity.allFinite() &&
                         event.after.velocity.allFinite() && event.after.angular_velocity.allFinite() &&
                         std::isfinite(event.energy_before) && std::isfinite(event.energy_after);
  if (is_finite) return {};
  return Broken{"every number of a switch is finite", at(event.time)};
}

Found chain(const Record& run) {
  Stage stage = Stage::holonomic;
  double time = 0;
  for (std::size_t i = 0; i < run.switches.size(); ++i) {
    const RecordedSwitch& event = run.switches[i];
    if (event.index != i) return Broken{"indices of switches are contiguous", at(event.time)};
    if (!(event.time >= time)) return Broken{"times never go back", "switch " + at(event.time)};
    const bool held = event.from_stage == Stage::nonholonomic;
    const bool holds = event.to_stage == Stage::nonholonomic;
    const SwitchKind kind = !held   ? SwitchKind::applied
                            : holds ? SwitchKind::exchanged
                                    : SwitchKind::released;
    if (event.from_stage != stage || !(held || holds) || event.kind != kind)
      return Broken{"a switch follows from the one before", at(event.time)};
    stage = event.to_stage;
    time = event.time;
  }
  if (run.states.back().stage != stage) return Broken{"the last state has the stage of the last switch", ""};
  for (std::size_t i = 1; i < run.states.size(); ++i) {
    if (!(run.states[i].time >= run.states[i - 1].time))
      return Broken{"times never go back", "state " + at(run.states[i].time)};
  }
  if (!(time <= run.states.back().time)) return Broken{"no switch is later than the last state", at(time)};
  return {};
}

/// The map by names, and how far a place may be off an edge.
class Map {
 public:
  explicit Map(const scene::Scene& scene) : scene_(scene) {}

  /// -1: the base; -2: no region of that name.
  int number_of(const std::string& name) const {
    if (name == scene::base_name) return -1;
    const auto& regions = scene_.surface.regions;
    const auto found =
        std::find_if(regions.begin(), regions.end(), [&](const auto& r) { return r.name == name; });
    return found == regions.end() ? -2 : static_cast<int>(found - regions.begin());
  }
  const scene::Material& material(int number) const {
    return number < 0 ? scene_.surface.base
                      : scene_.surface.regions[static_cast<std::size_t>(number)].material;
  }
  /// Whether a place belongs to the closed region, and no region above has it inside.
  std::string fault_of(int number, const Vector2d& place, double slack) const {
    const auto& regions = scene_.surface.regions;
    if (number >= 0) {
      const scene::Shape& shape = regions[static_cast<std::size_t>(number)].shape;
      const double distance = testing::distance_to_edge(shape, place);
      if (!testing::holds(shape, place) && distance > slack)
        return "the place is " + ::hybrid_sphere::fuzz::number(distance) + " m outside of it";
    }
    for (std::size_t i = static_cast<std::size_t>(number) + 1; i < regions.size(); ++i) {
      const double distance = testing::distance_to_edge(regions[i].shape, place);
      if (testing::holds(regions[i].shape, place) && distance > slack) {
        return "the place is " + ::hybrid_sphere::fuzz::number(distance) + " m inside " + regions[i].name +
               " above it";
      }
    }
    return "";
  }
  /// Rounding of places and edges, and of the way; of curves that are integrated their error, which is
  /// relative to the scale of motion.
  double slack(const Vector2d& place, double way, double error) const {
    double size = std::max(place.norm(), scene_.initial_state.position.norm());
    for (const scene::Region& region : scene_.surface.regions) size = std::max(size, extent(region.shape));
    return std::max({1e-9 * size, error * std::max(size, way), 64 * unit * way});
  }

 private:
  static double extent(const scene::Shape& shape) {
    if (const auto* half_plane = std::get_if<scene::HalfPlane>(&shape)) return half_plane->point.norm();
    if (const auto* circle = std::get_if<scene::Circle>(&shape))
      return circle->center.norm() + circle->radius;
    double size = 0;
    for (const Vector2d& vertex : std::get<scene::Polygon>(shape).vertices)
      size = std::max(size, vertex.norm());
    return size;
  }

  const scene::Scene& scene_;
};

/// All speeds that rounding is relative to.
double speed_scale(const scene::Scene& scene, const RecordedState& state) {
  double scale = state.twist.velocity.norm() + scene.sphere.radius * state.twist.angular_velocity.norm();
  const auto see = [&](const scene::Material& material) {
    scale = std::max(scale,
                     material.belt.norm() + std::abs(material.turntable_rate) *
                                                (state.position.norm() + material.turntable_center.norm()));
  };
  see(scene.surface.base);
  for (const scene::Region& region : scene.surface.regions) see(region.material);
  return scale;
}

/// Of the centre, of the contact and of the ground [m].
double longest_way(const scene::Scene& scene, const Record& run) {
  double speed = 0;
  for (const RecordedState& state : run.states) speed = std::max(speed, speed_scale(scene, state));
  return speed * run.states.back().time;
}

Found places(const scene::Scene& scene, const Map& map, const Record& run) {
  const double way = longest_way(scene, run);
  for (const RecordedSwitch& event : run.switches) {
    const int to = map.number_of(event.to);
    if (to == -2) return Broken{"a switch names a region of the map", at(event.time) + ": " + event.to};
    const std::string fault =
        map.fault_of(to, event.position, map.slack(event.position, way, run.estimated_error));
    if (!fault.empty()) {
      return Broken{"the place of a switch lies in the closed region that it names",
                    at(event.time) + " into " + event.to + ": " + fault};
    }
  }
  for (const RecordedState& state : run.states) {
    const int region = map.number_of(state.name);
    if (region == -2) return Broken{"a state names a region of the map", at(state.time) + ": " + state.name};
    const std::string fault =
        map.fault_of(region, state.position, map.slack(state.position, way, run.estimated_error));
    if (!fault.empty()) {
      return Broken{"a state names the ground under the sphere",
                    at(state.time) + " over " + state.name + ": " + fault};
    }
  }
  return {};
}

Found law(const scene::Scene& scene, const Map& map, const RecordedState& state) {
  const bool free = state.mode == Mode::free || state.mode == Mode::sliding;
  if ((state.stage == Stage::holonomic) != free)
    return Broken{"sliding and free motion are stage 1, all else stage 3", at(state.time)};
  if (state.mode == Mode::edge_sliding) return {};
  const scene::Material& ground = map.material(map.number_of(state.name));
  const bool rubs = ground.law == Law::coulomb && (ground.friction > 0 || ground.rolling_resistance > 0);
  const bool acts = rubs || ground.law == Law::rough || ground.law == Law::rubber;
  if (acts == (state.mode == Mode::free))
    return Broken{"the mode is one of the ground's law", at(state.time) + " on " + state.name};
  if (state.mode == Mode::sliding && ground.law != Law::coulomb)
    return Broken{"only coulomb ground lets the sphere slip", at(state.time)};
  if (free) return {};
  if (!state.slip.isZero(0)) return Broken{"the slip is 0 where the sphere rolls", at(state.time)};
  const Vector3d& omega = state.twist.angular_velocity;
  const Vector2d sigma = state.twist.velocity - scene.sphere.radius * Vector2d(omega.y(), -omega.x());
  const double slip = (sigma - ground_velocity(ground, state.position)).norm();
  const double scale = speed_scale(scene, state);
  if (!(slip <= 64 * unit * scale)) {
    return Broken{"the velocities have no slip where the sphere rolls",
                  at(state.time) + ": " + number(slip) + " m/s"};
  }
  if (ground.law == Law::rubber && omega.z() != ground.turntable_rate)
    return Broken{"no spin relative to rubber", at(state.time)};
  const double grip = ground.friction * state.reaction.z();
  const double reaction = state.reaction.head<2>().norm();
  const double slack = 1e-6 + 100 * scene.solver.accuracy;
  if (ground.law == Law::coulomb && !scene.solver.has_fixed_step() && reaction > grip * (1 + slack)) {
    return Broken{"rolling takes no more than the grip",
                  at(state.time) + ": " + number(reaction / grip) + " of it"};
  }
  return {};
}

bool moves(const scene::Material& material) {
  return !material.belt.isZero(0) || material.turntable_rate != 0;
}

/// Of motion and place: what forces that have a potential, on ground at rest, cannot raise.
struct Energy {
  double sum;    ///< [J]
  double scale;  ///< of its terms [J]
};

Energy energy_of(const scene::Scene& scene, const RecordedState& state) {
  const scene::SphereBody& sphere = scene.sphere;
  const scene::Forces& forces = scene.forces;
  const double spin = sphere.gyration_radius * state.twist.angular_velocity.norm();
  const double kinetic = sphere.mass * (state.twist.velocity.squaredNorm() + spin * spin) / 2;
  const Vector2d pull = sphere.mass * forces.gravity.head<2>() + forces.wrench.force;
  const double push = -pull.dot(state.position);
  const double spring = forces.spring.stiffness * (state.position - forces.spring.center).squaredNorm() / 2;
  return {kinetic + push + spring, kinetic + pull.norm() * state.position.norm() + spring};
}

Found energy(const scene::Scene& scene, const Record& run) {
  const auto& regions = scene.surface.regions;
  const bool moving =
      moves(scene.surface.base) ||
      std::any_of(regions.begin(), regions.end(), [](const auto& r) { return moves(r.material); });
  if (moving || !scene.forces.wrench.torque.isZero(0) || scene.solver.has_fixed_step()) return {};
  // Next to rounding a method may not keep the accuracy; the run says so.
  const double accuracy = std::max(scene.solver.accuracy, run.estimated_error);
  double scale = 0;
  double before = HUGE_VAL;
  for (const RecordedState& state : run.states) {
    const Energy now = energy_of(scene, state);
    scale = std::max(scale, now.scale);
    if (!std::isfinite(now.sum) || !std::isfinite(scale)) return {};
    // Errors of velocities and places; each of them counts twice, and once in each term.
    const double slack = (16 * accuracy + 1e-12) * scale;
    if (now.sum > before + slack) {
      return Broken{"ground at rest creates no energy",
                    at(state.time) + ": " + number(now.sum - before) + " of " + number(scale) + " J"};
    }
    before = std::min(before, now.sum);
  }
  return {};
}

Found fault_of(const scene::Scene& scene, const Record& coarse, const Record& fine) {
  for (const Record* run : {&coarse, &fine}) {
    for (const RecordedState& state : run->states)
      if (Found found = finite(state)) return found;
    for (const RecordedSwitch& event : run->switches)
      if (Found found = finite(event)) return found;
  }
  if (Found found = chain(fine)) return found;
  if (coarse.interrupted || fine.interrupted) return {};
  if (Found found = same_at_any_rate(coarse, fine)) return found;
  const Map map(scene);
  // Between two steps of a fixed length lies a cubic, which may be no path at all where they are much too
  // long.
  if (!scene.solver.has_fixed_step())
    if (Found found = places(scene, map, fine)) return found;
  // Where it halts at the first instant the ground has not acted yet.
  const bool has_begun = fine.halt.empty() || fine.states.size() > 1;
  for (const RecordedState& state : fine.states)
    if (Found found = has_begun ? law(scene, map, state) : Found()) return found;
  return energy(scene, fine);
}

}  // namespace

Verdict judge_invariants(const Case& a_case) {
  scene::Scene scene;
  try {
    scene = read_back(a_case.scene);
  } catch (const scene::SceneError& error) {
    return {Verdict::Kind::refused, reason_alone(error.what()), ""};
  }
  try {
    const Run first = run_for(a_case, scene, 1);
    const Run second = run_for(a_case, scene, 200);
    for (const Run* run : {&first, &second}) {
      if (asks_often(a_case, *run)) continue;
      // A virtual machine that stands still counts that as time of the process: not twice in a row.
      const Run again = run_for(a_case, scene, run == &first ? 1 : 200);
      if (!asks_often(a_case, again)) {
        return {Verdict::Kind::found, "a run asks in time whether to go on",
                number(again.silence) + " s, " + std::to_string(again.deaf) + " deaf blocks"};
      }
    }
    const Record& coarse = first.record;
    const Record& fine = second.record;
    if (const Found found = fault_of(scene, coarse, fine))
      return {Verdict::Kind::found, found->claim, found->words};
    if (coarse.interrupted) return judge_interrupted(a_case, scene, coarse);
    if (fine.interrupted) return judge_interrupted(a_case, scene, fine);
    if (fine.halt.empty()) return {};
    for (const Record* run : {&coarse, &fine}) {
      if (run->halt.find("forgotten") != std::string::npos)
        return {Verdict::Kind::found, "no motion is asked for what it has forgotten", run->halt};
    }
    if (fine.states.back().time > a_case.duration)
      return {Verdict::Kind::found, "a halt is not later than what was asked for", fine.halt};
    return {Verdict::Kind::halted, reason_alone(fine.halt), fine.halt};
  } catch (const std::exception& error) {
    // The method exact, asked for a motion without closed form.
    const bool documented = dynamic_cast<const scene::SceneError*>(&error) != nullptr ||
                            dynamic_cast<const std::invalid_argument*>(&error) != nullptr;
    if (documented && scene.solver.method == scene::Solver::Method::exact)
      return {Verdict::Kind::refused, reason_alone(error.what()), ""};
    return {Verdict::Kind::found, "no exception but the documented ones", error.what()};
  }
}

}  // namespace hybrid_sphere::fuzz
