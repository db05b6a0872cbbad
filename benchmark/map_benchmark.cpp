// What the size of a map costs: a crossing of an edge on maps of 10 to 100,000 regions that are alike around
// the path, and what it takes to read a large map and to make it ready. The counter that matters is the ratio
// of two lines of one run.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "geometry/simple_polygon.hpp"
#include "ground/ground.hpp"
#include "hybrid_sphere/simulation/simulation.hpp"
#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"

namespace {

using namespace hybrid_sphere;
using scene::Circle;
using scene::Law;
using scene::Polygon;

constexpr int on_the_way = 10;
constexpr int large = 100000;

Polygon quad(double x, double y) {
  return {{{x - 0.7, y - 0.5}, {x + 0.6, y - 0.6}, {x + 0.7, y + 0.4}, {x - 0.5, y + 0.6}}, false};
}

Polygon stripe(double x) { return {{{x - 0.6, -6}, {x + 0.2, -6}, {x + 0.6, 6}, {x - 0.2, 6}}, false}; }

scene::Shape shape(int kind, double x, double y) {
  if (kind % 2 == 0) return Circle{{x, y}, 0.7, false};
  return quad(x, y);
}

/// Stripes, discs and quads in a row along the first axis, 2 m apart; all others lie on a grid of the same
/// pitch on both sides of the row and at its end, with the row's middle in the middle.
scene::Surface map_of(int regions) {
  scene::Surface surface;
  const auto add = [&surface](const scene::Shape& shape) {
    const Law law = surface.regions.size() % 2 == 0 ? Law::rough : Law::smooth;
    surface.regions.push_back({"region_" + std::to_string(surface.regions.size()), shape, law});
  };
  for (int i = 0; i < on_the_way; ++i) {
    const double x = 2 * i;
    // Rough ones and smooth ones: no two that follow each other touch.
    add(i % 3 == 0 ? scene::Shape(stripe(x)) : shape(i, x, 0.2));
  }
  const int columns = std::max(on_the_way, static_cast<int>(std::sqrt(regions)));
  for (int i = 0; i < regions - on_the_way; ++i) {
    const int row = i / columns;
    const int pair = row / 2;
    const double y = (row % 2 == 0 ? 1 : -1) * (8 + 2 * pair);
    add(shape(i, 2 * (i % columns) - columns + on_the_way, y));
  }
  return surface;
}

scene::Scene scene_on(scene::Surface surface, const Vector3d& gravity) {
  scene::Scene scene{};
  scene.sphere = {2, 0.25, 0.25 * std::sqrt(0.4)};
  scene.initial_state.position = {-3, 0.1};
  scene.initial_state.velocity = {1, 0.01};
  scene.initial_state.angular_velocity = {0.5, 2, -2};
  scene.surface = std::move(surface);
  scene.forces.gravity = gravity;
  return scene;
}

/// From the start through the row: items are changes of the constraint, the placing of the sphere and the
/// reset shared among them.
void cross_the_row(benchmark::State& bench, const Vector3d& gravity) {
  Simulation simulation(scene_on(map_of(static_cast<int>(bench.range(0))), gravity));
  std::int64_t switches = 0;
  const Simulation::SwitchSink count = [&switches](const Switch&) { ++switches; };
  for (auto _ : bench) {
    simulation.reset();
    for (int i = 1; simulation.state().position.x() < 2 * on_the_way; ++i) simulation.advance_to(i, count);
  }
  bench.SetItemsProcessed(switches);
  bench.counters["crossings"] = static_cast<double>(switches) / static_cast<double>(bench.iterations());
}

void CrossingOfAStraightPath(benchmark::State& bench) {
  cross_the_row(bench, {0, 0, -scene::default_gravity});
}
BENCHMARK(CrossingOfAStraightPath)->Arg(on_the_way)->Arg(1000)->Arg(large);

/// Gravity along the plane bends the path.
void CrossingOfACurvedPath(benchmark::State& bench) {
  cross_the_row(bench, {0.05, 0.002, -scene::default_gravity});
}
BENCHMARK(CrossingOfACurvedPath)->Arg(on_the_way)->Arg(1000)->Arg(large);

void MakingAGround(benchmark::State& bench) {
  const scene::Surface surface = map_of(static_cast<int>(bench.range(0)));
  for (auto _ : bench) {
    bench.PauseTiming();
    scene::Surface copy = surface;
    bench.ResumeTiming();
    benchmark::DoNotOptimize(Ground(std::move(copy)));
  }
}
BENCHMARK(MakingAGround)->Arg(1000)->Arg(large)->Unit(benchmark::kMillisecond);

void TopRegion(benchmark::State& bench) {
  const Ground ground(map_of(static_cast<int>(bench.range(0))));
  double x = 0;
  for (auto _ : bench) {
    benchmark::DoNotOptimize(ground.top_region({x, 0.1}));
    x = x < 20 ? x + 0.01 : 0;
  }
}
BENCHMARK(TopRegion)->Arg(on_the_way)->Arg(1000)->Arg(large);

/// Quads side by side, as a scene file has them.
std::string text_of_quads(int count) {
  std::string text = "regions:\n";
  for (int i = 0; i < count; ++i) {
    text += "- {name: region_" + std::to_string(i) + ", law: rough, polygon: [";
    const int row = i / 300;
    for (const Vector2d& p : quad(2 * (i % 300), 2 * row).vertices) {
      text += "[" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + "], ";
    }
    text += "]}\n";
  }
  return text;
}

void ParsingTheTextOfPolygons(benchmark::State& bench) {
  const std::string text = text_of_quads(large);
  for (auto _ : bench) benchmark::DoNotOptimize(scene::tree_from_yaml(text));
  bench.SetBytesProcessed(bench.iterations() * static_cast<std::int64_t>(text.size()));
}
BENCHMARK(ParsingTheTextOfPolygons)->Unit(benchmark::kMillisecond);

void ReadingPolygons(benchmark::State& bench) {
  const scene::Tree tree = scene::tree_from_yaml(text_of_quads(large));
  for (auto _ : bench) benchmark::DoNotOptimize(scene::read_surface(tree));
}
BENCHMARK(ReadingPolygons)->Unit(benchmark::kMillisecond);

/// Long teeth side by side: their sides overlap each other along both axes.
void CheckingACombOfFortyThousandSides(benchmark::State& bench) {
  std::vector<Vector2d> comb;
  const auto add = [&comb](double x, double y) { comb.emplace_back(x - y, x + y); };
  for (int i = 0; i < 10000; ++i) {
    const double y = 4 * i;
    add(0, y);
    add(100000, y + 1);
    add(100000, y + 2);
    add(0, y + 3);
  }
  add(-10, 40000);
  add(-10, -1);
  for (auto _ : bench) {
    if (geometry::fault_of_polygon(comb)) throw std::logic_error("the comb is simple");
  }
}
BENCHMARK(CheckingACombOfFortyThousandSides)->Unit(benchmark::kMillisecond);

}  // namespace
