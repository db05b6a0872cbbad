// What the exact method costs: an output, against the least that any program must compute for it, and a
// crossing of an edge. The counter that matters is the ratio of two lines of one run.
#include <benchmark/benchmark.h>

#include <cmath>

#include "hybrid_sphere/simulation/simulation.hpp"

namespace {

using namespace hybrid_sphere;
using scene::Circle;
using scene::HalfPlane;
using scene::Law;
using scene::Polygon;

scene::Scene paper() {
  scene::Scene scene{};
  scene.sphere = {2, 0.25, 0.25 * std::sqrt(0.4)};
  scene.initial_state.position = {-3, 0.5};
  scene.initial_state.velocity = {1, -0.375};
  scene.initial_state.angular_velocity = {4, 1.5, -2};
  scene.surface.regions = {{"rough_half", HalfPlane{{0, 0}, {1, 0}}, Law::rough}};
  return scene;
}

/// Ten regions of all shapes in a row, alternately rough and smooth below and on the way.
scene::Scene ten_regions() {
  scene::Scene scene = paper();
  scene.surface.regions.clear();
  for (int i = 0; i < 10; ++i) {
    const double x = 2 * i;
    const std::string name = "region_" + std::to_string(i);
    const Law law = i % 2 == 0 ? Law::rough : Law::smooth;
    if (i % 3 == 0) {
      scene.surface.regions.push_back({name, Circle{{x, -1}, 1.1, false}, law});
    } else if (i % 3 == 1) {
      scene.surface.regions.push_back(
          {name, Polygon{{{x - 1, -9}, {x + 0.5, -8}, {x + 1, 9}, {x - 0.5, 8}}, false}, law});
    } else {
      scene.surface.regions.push_back({name, HalfPlane{{x, 0}, {1, 0.1}}, law});
    }
  }
  return scene;
}

/// The least that an output needs: position, velocity and the exponential map, from the same start of a
/// segment.
struct Minimum {
  double x0, y0, vx, vy, half_rate, ax, ay, az;
  Quaterniond q0;

  struct Output {
    double x, y, vx, vy, qx, qy, qz, qw;
  };

  Output at(double tau) const {
    const double angle = half_rate * tau;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const Quaterniond q = Quaterniond(c, s * ax, s * ay, s * az) * q0;
    return {x0 + vx * tau, y0 + vy * tau, vx, vy, q.x(), q.y(), q.z(), q.w()};
  }
};

constexpr double tick = 1e-3;
constexpr int ticks = 10000;  // after the switch at t = 3: one segment

void HandWrittenMinimum(benchmark::State& bench) {
  Simulation simulation(paper());
  simulation.advance_to(4, {});
  const State state = simulation.state();
  const Vector3d& omega = state.twist.angular_velocity;
  const Vector3d axis = omega.normalized();
  const Minimum minimum{state.position.x(),
                        state.position.y(),
                        state.twist.velocity.x(),
                        state.twist.velocity.y(),
                        0.5 * omega.norm(),
                        axis.x(),
                        axis.y(),
                        axis.z(),
                        state.orientation};
  for (auto _ : bench) {
    for (int i = 0; i < ticks; ++i) benchmark::DoNotOptimize(minimum.at(tick * i));
  }
  bench.SetItemsProcessed(bench.iterations() * ticks);
}
BENCHMARK(HandWrittenMinimum);

void ExactOutput(benchmark::State& bench) {
  Simulation simulation(paper());
  const Simulation::SwitchSink ignore = [](const Switch&) {};
  simulation.advance_to(4, ignore);
  double start = 4;
  for (auto _ : bench) {
    for (int i = 0; i < ticks; ++i) {
      simulation.advance_to(start + tick * i, ignore);
      benchmark::DoNotOptimize(simulation.state());
    }
    bench.PauseTiming();
    simulation.reset();
    simulation.advance_to(4, ignore);
    bench.ResumeTiming();
  }
  bench.SetItemsProcessed(bench.iterations() * ticks);
}
BENCHMARK(ExactOutput);

/// From the start through all ten regions: items are crossings of edges, the placing of the sphere shared
/// among them.
void CrossingInTenRegions(benchmark::State& bench) {
  const scene::Scene scene = ten_regions();
  Simulation simulation(scene);
  std::int64_t switches = 0;
  const Simulation::SwitchSink count = [&switches](const Switch&) { ++switches; };
  for (auto _ : bench) {
    simulation.reset();
    simulation.advance_to(100, count);
    benchmark::DoNotOptimize(simulation.state());
  }
  bench.SetItemsProcessed(switches);
}
BENCHMARK(CrossingInTenRegions);

/// The most expensive crossing: the one with the impulse, after which all regions are traced along the new
/// path.
void CrossingWithImpulseInTenRegions(benchmark::State& bench) {
  const scene::Scene scene = ten_regions();
  Simulation simulation(scene);
  double first = 0;
  simulation.advance_to(100, [&first](const Switch& event) {
    if (event.index == 0) first = event.time;
  });
  const Simulation::SwitchSink ignore = [](const Switch&) {};
  const double before = 0.999 * first;
  for (auto _ : bench) {
    simulation.reset();
    simulation.advance_to(bench.range(0) == 0 ? before : first, ignore);
  }
}
BENCHMARK(CrossingWithImpulseInTenRegions)->Arg(0)->Arg(1);

}  // namespace
