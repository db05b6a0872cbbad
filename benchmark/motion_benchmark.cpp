// What an output costs in each kind of motion, and what the paper's scene costs as a whole. The counter that
// matters is the ratio to PaperRolling in one run. Behind the slash of a motion that turns is the accuracy: 9
// is 1e-9, the default.
#include <benchmark/benchmark.h>

#include <cmath>

#include "hybrid_sphere/simulation/simulation.hpp"

namespace {

using namespace hybrid_sphere;
using scene::HalfPlane;
using scene::Law;
using scene::Material;

constexpr double rate = 1000;  // Hz
constexpr int outputs = 2000;

scene::Scene on(const Material& ground) {
  scene::Scene scene{};
  scene.sphere = {2, 0.25, 0.25 * std::sqrt(0.4)};
  scene.initial_state.position = {-3, 0.5};
  scene.initial_state.velocity = {1, -0.375};
  scene.initial_state.angular_velocity = {4, 1.5, -2};
  scene.surface.base = ground;
  return scene;
}

Material coulomb(double friction) {
  Material material(Law::coulomb);
  material.friction = friction;
  return material;
}

Material turning(Law law, double turntable_rate) {
  Material material(law);
  material.turntable_rate = turntable_rate;
  return material;
}

/// Outputs of one segment, after everything at the start has happened.
void run(benchmark::State& bench, scene::Scene scene, double accuracy = scene::Solver().accuracy) {
  scene.solver.accuracy = accuracy;
  Simulation simulation(scene);
  const Simulation::SwitchSink ignore = [](const Switch&) {};
  for (auto _ : bench) {
    simulation.reset();
    for (int i = 0; i < outputs; ++i) {
      simulation.advance_to(i / rate, ignore);
      benchmark::DoNotOptimize(simulation.state());
    }
  }
  bench.SetItemsProcessed(bench.iterations() * outputs);
  bench.counters["rhs"] =
      static_cast<double>(simulation.evaluations()) / static_cast<double>(bench.iterations());
}

double accuracy(const benchmark::State& bench) { return std::pow(10, -static_cast<double>(bench.range(0))); }

void PaperRolling(benchmark::State& bench) { run(bench, on(Law::rough)); }
BENCHMARK(PaperRolling);

void SmoothSlope(benchmark::State& bench) {
  scene::Scene scene = on(Law::smooth);
  scene.forces.gravity.x() = 1;
  run(bench, scene);
}
BENCHMARK(SmoothSlope);

void RoughSlope(benchmark::State& bench) {
  scene::Scene scene = on(Law::rough);
  scene.forces.gravity.x() = 1;
  run(bench, scene, accuracy(bench));
}
BENCHMARK(RoughSlope)->Arg(3)->Arg(6)->Arg(9);

void RoughSlopeFromRest(benchmark::State& bench) {
  scene::Scene scene = on(Law::rough);
  scene.initial_state.velocity = {0, 0};
  scene.initial_state.angular_velocity = {0, 0, 0};
  scene.forces.gravity.x() = 1;
  run(bench, scene, accuracy(bench));
}
BENCHMARK(RoughSlopeFromRest)->Arg(3)->Arg(6)->Arg(9);

void TurntableCircle(benchmark::State& bench) { run(bench, on(turning(Law::rough, 3)), accuracy(bench)); }
BENCHMARK(TurntableCircle)->Arg(3)->Arg(6)->Arg(9);

void TurntableCycloid(benchmark::State& bench) {
  scene::Scene scene = on(turning(Law::rough, 3));
  scene.forces.gravity.x() = 1;
  run(bench, scene, accuracy(bench));
}
BENCHMARK(TurntableCycloid)->Arg(3)->Arg(6)->Arg(9);

void SmoothWithDrag(benchmark::State& bench) {
  scene::Scene scene = on(Law::smooth);
  scene.forces.drag = {0.5, 0.01, 0};
  run(bench, scene, accuracy(bench));
}
BENCHMARK(SmoothWithDrag)->Arg(3)->Arg(6)->Arg(9);

void RoughWithSpring(benchmark::State& bench) {
  scene::Scene scene = on(Law::rough);
  scene.forces.spring.stiffness = 3;
  run(bench, scene, accuracy(bench));
}
BENCHMARK(RoughWithSpring)->Arg(3)->Arg(6)->Arg(9);

void SlidingOnTheLevel(benchmark::State& bench) { run(bench, on(coulomb(0.01)), accuracy(bench)); }
BENCHMARK(SlidingOnTheLevel)->Arg(3)->Arg(6)->Arg(9);

void SlidingDownASlope(benchmark::State& bench) {
  scene::Scene scene = on(coulomb(0.05));
  scene.forces.gravity.x() = 3;
  run(bench, scene, accuracy(bench));
}
BENCHMARK(SlidingDownASlope)->Arg(3)->Arg(6)->Arg(9);

void RollingToRest(benchmark::State& bench) {
  Material material(Law::rough);
  material.rolling_resistance = 0.001;
  run(bench, on(material), accuracy(bench));
}
BENCHMARK(RollingToRest)->Arg(3)->Arg(6)->Arg(9);

void RollingToRestOnASlope(benchmark::State& bench) {
  Material material(Law::rough);
  material.rolling_resistance = 0.01;
  scene::Scene scene = on(material);
  scene.forces.gravity.x() = 0.3;
  run(bench, scene, accuracy(bench));
}
BENCHMARK(RollingToRestOnASlope)->Arg(3)->Arg(6)->Arg(9);

void IntegratedQuadraticDrag(benchmark::State& bench) {
  scene::Scene scene = on(Law::smooth);
  scene.forces.drag.quadratic = 0.5;
  run(bench, scene, accuracy(bench));
}
BENCHMARK(IntegratedQuadraticDrag)->Arg(3)->Arg(6)->Arg(9);

void IntegratedSlidingOnATurntable(benchmark::State& bench) {
  Material material = turning(Law::coulomb, 3);
  material.friction = 0.01;
  run(bench, on(material), accuracy(bench));
}
BENCHMARK(IntegratedSlidingOnATurntable)->Arg(3)->Arg(6)->Arg(9);

/// Ten seconds at 100 Hz, with the switch.
void PaperSceneAsAWhole(benchmark::State& bench) {
  scene::Scene scene = on(Law::smooth);
  scene.surface.regions = {{"rough_half", HalfPlane{{0, 0}, {1, 0}}, Law::rough}};
  Simulation simulation(scene);
  const Simulation::SwitchSink ignore = [](const Switch&) {};
  for (auto _ : bench) {
    simulation.reset();
    for (int i = 0; i <= 1000; ++i) {
      simulation.advance_to(i / 100., ignore);
      benchmark::DoNotOptimize(simulation.state());
    }
  }
}
BENCHMARK(PaperSceneAsAWhole);

/// The paper's scene from another initial state each time: where the sphere is after five seconds, and one
/// switch.
void WholeTrajectories(benchmark::State& bench) {
  scene::Scene scene = on(Law::smooth);
  scene.surface.regions = {{"rough_half", HalfPlane{{0, 0}, {1, 0}}, Law::rough}};
  Simulation simulation(scene);
  simulation.follow_orientation(bench.range(0) != 0);
  const Simulation::SwitchSink ignore = [](const Switch&) {};
  double speed = 1;
  for (auto _ : bench) {
    speed = speed > 2 ? 1 : speed + 0x1p-10;
    scene.initial_state.velocity.x() = speed;
    simulation.set_initial_state(scene.initial_state);
    simulation.advance_to(5, ignore);
    benchmark::DoNotOptimize(simulation.state());
  }
  bench.SetItemsProcessed(bench.iterations());
}
BENCHMARK(WholeTrajectories)->Arg(0)->Arg(1);

/// The state of a free sphere that a torque turns faster and faster, omega = (4, 2 + 3.57 t, -2), at a time.
void FastSpin(benchmark::State& bench) {
  scene::Scene scene = on(Law::smooth);
  scene.initial_state.angular_velocity = {4, 2, -2};
  const double inertia = scene.sphere.mass * scene.sphere.gyration_radius * scene.sphere.gyration_radius;
  scene.forces.wrench.torque.y() = 3.57 * inertia;
  Simulation simulation(scene);
  for (auto _ : bench) {
    simulation.reset();
    simulation.advance_to(static_cast<double>(bench.range(0)));
    benchmark::DoNotOptimize(simulation.state());
  }
}
BENCHMARK(FastSpin)->Arg(748)->Arg(23668);

}  // namespace
