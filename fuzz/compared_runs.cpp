#include "compared_runs.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <sstream>
#include <variant>
#include <vector>

#include "ground/crossing.hpp"
#include "simulation/edge_line.hpp"
#include "sphere/constants.hpp"
#include "support/place.hpp"

namespace hybrid_sphere::fuzz {

using testing::Record;
using testing::RecordedState;

namespace {

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

}  // namespace

std::string off_at(double time, double error, double allowed) {
  std::ostringstream text;
  text.precision(17);
  text << "at t = " << time << " off by " << error << " m, allowed " << allowed;
  return text.str();
}

scene::Scene neighbour(scene::Scene scene, double part) {
  scene.initial_state.velocity *= 1 + part;
  scene.initial_state.angular_velocity *= 1 - part;
  scene.forces.gravity.head<2>() *= 1 + part;
  scene.forces.wrench.force *= 1 + part;
  scene.forces.wrench.torque *= 1 - part;
  scene.forces.spring.stiffness *= 1 - part;
  return scene;
}

bool same_switches(const Record& a, const Record& b) {
  return a.halt.empty() == b.halt.empty() && a.switches.size() == b.switches.size() &&
         std::equal(a.switches.begin(), a.switches.end(), b.switches.begin(),
                    [](const auto& x, const auto& y) { return x.to == y.to && x.kind == y.kind; });
}

bool accumulates_before(double instant, const Record& record, double span) {
  constexpr std::size_t many = 32;
  const auto& events = record.switches;
  for (std::size_t i = many; i < events.size(); ++i) {
    const double passed = events[i].time - events[i - many].time;
    if (passed <= 1e-9 * span && std::abs(events[i].time - instant) <= 1e-9 * span) return true;
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

Found compare(const Plain& plain, const Record& other, const char* claim, const Place& place, double extra) {
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
    const double fast =
        halts ? 0 : std::max(state.twist.velocity.norm(), other.states[i].twist.velocity.norm());
    if (error <= allowed + later * fast) continue;
    if (passes_in_no_time(plain.record) != passes_in_no_time(other)) return {};
    return Broken{claim, halts ? "the other halts: " + other.halt : off_at(state.time, error, allowed)};
  }
  return {};
}

Record run_for(double seconds, const scene::Scene& scene, double duration) {
  return testing::record(scene, duration, compared_outputs, [begin = std::clock(), seconds] {
    return static_cast<double>(std::clock() - begin) > seconds * CLOCKS_PER_SEC;
  });
}

Plain plain_run(const Case& a_case, double seconds) {
  const auto record = [&](const scene::Scene& scene) { return run_for(seconds, scene, a_case.duration); };
  return {a_case,
          record(a_case.scene),
          {record(neighbour(a_case.scene, shift)), record(neighbour(a_case.scene, -shift))}};
}

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

namespace {

constexpr double little = 1e-12;  // of the places of a scene

/// Not on it, but within rounding of it: that is left a time sqrt(2 r/a) later, at a speed of sqrt(2 r a).
bool starts_beside_an_edge(const scene::Scene& scene, double size) {
  const Vector2d& start = scene.initial_state.position;
  return std::any_of(scene.surface.regions.begin(), scene.surface.regions.end(), [&](const auto& region) {
    const double of_lines = distance_to_lines(region.shape, start);
    const bool is_beside_edge = testing::distance_to_edge(region.shape, start) <= little * size &&
                                locate(region.shape, start) != Side::edge;
    return is_beside_edge || (of_lines > 0 && of_lines <= little * size);
  });
}

/// So slowly that gravity would turn it back within a part of the size of places.
bool starts_slowly(const scene::Scene& scene, double size, double part) {
  const double speed = scene.initial_state.velocity.norm();
  return speed > 0 && speed * speed <= 2 * scene.forces.gravity.norm() * part * size;
}

bool is_thin(const scene::Shape& shape) {
  const auto* polygon = std::get_if<scene::Polygon>(&shape);
  if (!polygon) return false;
  const Vector2d& first = polygon->vertices.front();
  double area = 0;
  double size = 0;
  Vector2d before = Vector2d::Zero();
  for (const Vector2d& vertex : polygon->vertices) {
    area += 0.5 * turned(before).dot(vertex - first);
    before = vertex - first;
    size = std::max(size, before.norm());
  }
  return std::abs(area) <= 1e-11 * size * size;
}

}  // namespace

double way_hidden_by_rounding(const Plain& plain) {
  const scene::Scene& scene = plain.a_case.scene;
  const auto& regions = scene.surface.regions;
  const double size = scene.initial_state.position.norm() + way_of(plain.record);
  const bool has_thin =
      std::any_of(regions.begin(), regions.end(), [](const auto& region) { return is_thin(region.shape); });
  const bool is_slow = starts_slowly(scene, size, little);
  if (!has_thin && !is_slow && !starts_beside_an_edge(scene, size)) return 0;
  // For want of a better one, the acceleration is that of a fall. The error at a slow start is one of all
  // that follows.
  const double hidden = std::sqrt(2 * rounding * size * scene.forces.gravity.norm()) * plain.a_case.duration;
  return is_slow ? 16 * hidden : hidden;
}

bool is_lost_on_an_edge(const scene::Scene& scene) {
  const double size = size_of_places(scene);
  const auto& regions = scene.surface.regions;
  const auto is_there = [&](const scene::Region& region) {
    return testing::distance_to_edge(region.shape, scene.initial_state.position) <= little * size;
  };
  return starts_slowly(scene, size, rounding) && std::any_of(regions.begin(), regions.end(), is_there);
}

bool stands_on_an_edge(const Plain& plain) {
  const scene::Scene& scene = plain.a_case.scene;
  const double size = size_of_places(scene) + way_of(plain.record);
  const auto stands = [&](const Switch& event) {
    const double way = event.before.velocity.norm() * plain.a_case.duration;
    const auto is_there = [&](const scene::Region& region) {
      return testing::distance_to_edge(region.shape, event.position) <= rounding * size;
    };
    return event.time > 0 && way <= rounding * size &&
           std::any_of(scene.surface.regions.begin(), scene.surface.regions.end(), is_there);
  };
  return std::any_of(plain.record.switches.begin(), plain.record.switches.end(), stands);
}

double size_of_places(const scene::Scene& scene) {
  double size = scene.initial_state.position.norm();
  for (const scene::Region& region : scene.surface.regions) size = std::max(size, size_of(region.shape));
  return size;
}

bool is_less_than_rounding(const Case& a_case, double size) {
  const scene::InitialState& start = a_case.scene.initial_state;
  const double turning = a_case.scene.sphere.radius * start.angular_velocity.head<2>().norm();
  const auto is_less = [&](double speed) { return speed > 0 && speed * a_case.duration < rounding * size; };
  return is_less(start.velocity.norm()) || is_less(turning);
}

}  // namespace hybrid_sphere::fuzz
