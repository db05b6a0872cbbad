#include "scenes.hpp"

#include <cmath>

#include "hybrid_sphere/simulation/simulation.hpp"

namespace hybrid_sphere::work_precision {
namespace {

using scene::HalfPlane;
using scene::Law;
using scene::Polygon;

scene::Scene sphere_with(const Vector2d& position, const Vector2d& velocity, const Vector3d& spin) {
  scene::Scene scene{};
  scene.sphere = {2, 0.25, 0.25 * std::sqrt(0.4)};
  scene.initial_state = {position, Quaterniond::Identity(), velocity, spin};
  return scene;
}

/// Rough ground beyond a line, in strips of a width; between them and before the line it is as before.
void add_strips(scene::Scene& scene, int count, double width, double tilt) {
  const Vector2d across(std::cos(tilt), std::sin(tilt));
  const Vector2d along(-std::sin(tilt), std::cos(tilt));
  for (int i = 0; i < count; ++i) {
    const Vector2d low = 2 * i * width * across;
    const Vector2d high = (2 * i + 1) * width * across;
    scene.surface.regions.push_back(
        {"strip_" + std::to_string(i),
         Polygon{{low - 20 * along, high - 20 * along, high + 20 * along, low + 20 * along}}, Law::rough});
  }
}

scene::Scene paper() {
  scene::Scene scene = sphere_with({-0.98909090909090909, 0.5}, {2, -0.75}, {4, 5, -2});
  scene.surface.regions = {{"rough_half", HalfPlane{{0, 0}, {1, 0}}, Law::rough}};
  return scene;
}

scene::Scene strips() {
  scene::Scene scene = sphere_with({-0.35, 0}, {0.8, 0.3}, {1, 2, -2});
  add_strips(scene, 40, 0.1, M_PI / 180);
  return scene;
}

scene::Scene incline() {
  scene::Scene scene = sphere_with({0, 0}, {-1.5, 0.75}, {-3, -6, 2});
  scene.surface.base.law = Law::rough;
  scene.surface.regions = {{"ice", HalfPlane{{1, 0}, {1, 0.1}}, Law::smooth},
                           {"gravel", HalfPlane{{4, 0}, {1, -0.1}}, Law::rough}};
  scene.forces.gravity = {1.7034885, 0, -9.6609641};
  return scene;
}

scene::Scene sliding() {
  scene::Scene scene = sphere_with({0, 0}, {-1, 2}, {6, -3, 1});
  scene.surface.base = Law::coulomb;
  scene.surface.base.friction = 0.1;
  scene.forces.gravity = {3.5, 0, -9.2};
  return scene;
}

scene::Scene turntable() {
  scene::Scene scene = sphere_with({0.4, -0.3}, {1, 0.5}, {2, -3, 1.5});
  scene.surface.base = Law::rough;
  scene.surface.base.turntable_rate = 2;
  scene.forces.gravity = {0.5, -0.25, -9.81};
  return scene;
}

/// States half way between two switches, from closed forms.
Problem solved(const std::string& name, const scene::Scene& scene, double until) {
  Problem problem{name, scene, {}, 0};
  std::vector<double> times{0};
  Simulation first(scene);
  first.advance_to(until, [&times](const Switch& event) { times.push_back(event.time); });
  problem.switches = first.switches();
  times.push_back(until);
  Simulation simulation(scene);
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] == times[i - 1]) continue;
    simulation.advance_to(0.5 * (times[i - 1] + times[i]), {[](const Switch&) {}});
    problem.truth.push_back(simulation.state());
  }
  return problem;
}

/// A straight way with quadratic drag: v' = -c' v^2, c' = c on smooth ground and (1 - kappa) c on rough; the
/// rotation keeps its axis. Everything in the way's length: v = v_0 exp(-c' s), t = (exp(c' s) - 1)/(c' v_0).
Problem quadratic_drag() {
  constexpr int strips = 50;
  constexpr long double width = 0.0625L;
  constexpr long double drag = 0.25L;  // of a kilogram [1/m]
  const Vector2d direction(0.8, 0.6);
  scene::Scene scene = sphere_with({-0.0625, 0}, 2 * direction, {0, 0, 0});
  scene.sphere.gyration_radius = 0.125;
  scene.forces.drag.quadratic = static_cast<double>(drag) * scene.sphere.mass;
  add_strips(scene, strips, static_cast<double>(width), 0);
  Problem problem{"quadratic_drag", scene, {}, 2 * strips};
  const long double kappa = 0.2L;  // k^2/(R^2 + k^2)
  const long double radius = 0.25L;
  const long double piece = width / 0.8L;
  long double time = 0, v = 2, rolled = 0, nu = 0, angle = 0;
  for (int i = 0; i <= 2 * strips; ++i) {
    const bool rough = i % 2 == 1;
    if (rough) {
      v -= kappa * (v - nu);
      nu = v;
    }
    const long double c = rough ? (1 - kappa) * drag : drag;
    const auto time_of = [&](long double s) { return std::expm1(c * s) / (c * v); };
    const auto angle_of = [&](long double s) { return (rough ? s : nu * time_of(s)) / radius; };
    const long double half = 0.5L * piece;
    State state;
    state.time = static_cast<double>(time + time_of(half));
    state.position = scene.initial_state.position + static_cast<double>(rolled + half) * direction;
    state.twist.velocity = static_cast<double>(v * std::exp(-c * half)) * direction;
    const Vector3d axis(-direction.y(), direction.x(), 0);
    const double spin = static_cast<double>((rough ? v * std::exp(-c * half) : nu) / radius);
    state.twist.angular_velocity = spin * axis;
    state.orientation = Eigen::AngleAxisd(static_cast<double>(angle + angle_of(half)), axis);
    problem.truth.push_back(state);
    time += time_of(piece);
    angle += angle_of(piece);
    rolled += piece;
    v *= std::exp(-c * piece);
    if (rough) nu = v;
  }
  return problem;
}

}  // namespace

std::vector<Problem> problems() {
  return {solved("paper", paper(), 2),         solved("strips", strips(), 10),
          solved("incline", incline(), 5),     solved("sliding", sliding(), 3),
          solved("turntable", turntable(), 5), quadratic_drag()};
}

}  // namespace hybrid_sphere::work_precision
