// hybrid_sphere beside the event loops of event_loops.hpp: cost of an event over the number of regions, wrong
// decisions at paths that all but touch a disc, and the error after a thousand events. CSV on standard
// output: what, loop, regions, value.
#include <chrono>
#include <cstdio>
#include <functional>
#include <random>

#include "event_loops.hpp"
#include "geometry/hundred_digits.hpp"
#include "hybrid_sphere/simulation/simulation.hpp"

namespace hybrid_sphere::peers {
namespace {

using Clock = std::chrono::steady_clock;
using exact::Real;

constexpr double kappa = 2.0 / 7;
const scene::SphereBody ball{1, 0.1, 0.1 * std::sqrt(0.4)};

double seconds_of(const std::function<void()>& work) {
  constexpr int repetitions = 5;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repetitions; ++i) {
    const auto start = Clock::now();
    work();
    least = std::min(least, std::chrono::duration<double>(Clock::now() - start).count());
  }
  return least;
}

void print(const char* what, const char* loop, std::size_t regions, double value) {
  std::printf("%s,%s,%zu,%.4g\n", what, loop, regions, value);
}

/// A row of discs along x, each with a belt of its own, that a path along it enters and leaves.
std::vector<Disc<double>> row_of(int size) {
  std::vector<Disc<double>> discs;
  for (int i = 0; i < size; ++i) {
    discs.push_back(
        {{i + 1.0, 0.2 * std::sin(1.7 * i)}, 0.35, {0.02 * std::cos(i), 1e-3 * std::sin(3.0 * i)}});
  }
  return discs;
}

scene::Scene scene_of(const std::vector<Disc<double>>& discs) {
  scene::Scene scene{};
  scene.sphere = ball;
  scene.initial_state.velocity = {1, 0};
  for (std::size_t i = 0; i < discs.size(); ++i) {
    scene::Material rough(scene::Law::rough);
    rough.belt = discs[i].belt;
    scene.surface.regions.push_back(
        {"disc_" + std::to_string(i), scene::Circle{discs[i].center, discs[i].radius, false}, rough});
  }
  return scene;
}

template <class Number>
BilliardLoop<Number> loop_of(const std::vector<Disc<double>>& discs, const Number& coupling) {
  std::vector<Disc<Number>> converted;
  for (const Disc<double>& disc : discs) {
    converted.push_back({disc.center.cast<Number>(), Number(disc.radius), disc.belt.cast<Number>()});
  }
  BilliardLoop<Number> loop(std::move(converted), coupling);
  const Vector<Number> velocity(Number(1), Number(0));
  loop.place(Vector<Number>::Zero(), velocity, velocity);  // the sphere does not turn at first
  return loop;
}

void compare_costs_of_straight_paths() {
  for (const int size : {10, 100, 1000, 10000}) {
    const std::vector<Disc<double>> discs = row_of(size);
    const int events = std::min(2 * size, 200);
    Simulation simulation(scene_of(discs));
    simulation.follow_orientation(false);
    double end = 0;
    int switches = 0;
    while (switches < events) simulation.advance_to(++end, [&](const Switch&) { ++switches; });
    const double ours = seconds_of([&] {
      simulation.reset();
      simulation.advance_to(end, [](const Switch&) {});
    });
    print("nanoseconds of an event on a straight path", "hybrid_sphere", discs.size(), 1e9 * ours / switches);
    BilliardLoop<double> loop = loop_of(discs, kappa);
    const Vector<double> velocity(1, 0);
    const double theirs = seconds_of([&] {
      loop.place(Vector<double>::Zero(), velocity, velocity);
      for (int i = 0; i < events; ++i) loop.pass();
    });
    print("nanoseconds of an event on a straight path", "billiard", discs.size(), 1e9 * theirs / events);
  }
}

/// Down a slope past discs that lie in a row: one event each of the two, to the first disc.
void compare_costs_of_parabolas() {
  const Vector2d acceleration(0.05, 0.002);
  const Vector2d velocity(1, 0);
  for (const int size : {10, 100, 1000}) {
    std::vector<Disc<double>> discs = row_of(size);
    scene::Scene scene = scene_of(discs);
    scene.forces.gravity = {acceleration.x(), acceleration.y(), -9.81};
    Simulation simulation(scene);
    simulation.follow_orientation(false);
    const PoolLoop loop(discs);
    const double contact = loop.first_contact(Vector2d::Zero(), velocity, acceleration);
    constexpr int times = 100;
    const double ours = seconds_of([&] {
      for (int i = 0; i < times; ++i) {
        simulation.reset();
        simulation.advance_to(1.001 * contact, [](const Switch&) {});
      }
    });
    print("nanoseconds of an event on a parabola", "hybrid_sphere", discs.size(), 1e9 * ours / times);
    double sum = 0;
    const double theirs = seconds_of([&] {
      for (int i = 0; i < times; ++i) sum += loop.first_contact(Vector2d::Zero(), velocity, acceleration);
    });
    if (!(sum > 0)) std::fprintf(stderr, "compare_events: no contact\n");
    print("nanoseconds of an event on a parabola", "pool", discs.size(), 1e9 * theirs / times);
  }
}

/// Paths along tangents of a disc, as well as numbers hold them; in a hundred digits each enters it or not.
void compare_grazes() {
  constexpr int trials = 200'000;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  Simulation simulation(scene_of({{{0, 0}, 1, {0, 0}}}));
  simulation.follow_orientation(false);
  BilliardLoop<double> loop({{{0, 0}, 1, {0, 0}}}, kappa);
  int wrong = 0;
  int theirs_wrong = 0;
  for (int i = 0; i < trials; ++i) {
    const Vector2d start(-3 + any(random), 2 * any(random));
    const double angle = std::atan2(-start.y(), -start.x()) + std::asin(1 / start.norm());
    const Vector2d velocity(std::cos(angle), std::sin(angle));
    const Real across = Real(start.x()) * velocity.y() - Real(start.y()) * velocity.x();
    const Real square = Real(velocity.x()) * velocity.x() + Real(velocity.y()) * velocity.y();
    const bool enters = across * across < square;
    scene::InitialState state;
    state.position = start;
    state.velocity = velocity;
    simulation.set_initial_state(state);
    simulation.advance_to(10, [](const Switch&) {});
    wrong += (simulation.switches() > 0) == enters ? 0 : 1;
    loop.place(start, velocity, velocity);
    theirs_wrong += (loop.pass() != none) == enters ? 0 : 1;
  }
  print("wrong decisions in a million at tangents", "hybrid_sphere", 1, 1e6 / trials * wrong);
  print("wrong decisions in a million at tangents", "billiard", 1, 1e6 / trials * theirs_wrong);
}

/// The places of the thousandth event.
void compare_errors() {
  constexpr int events = 1000;
  const std::vector<Disc<double>> discs = row_of(events / 2);
  BilliardLoop<double> loop = loop_of(discs, kappa);
  BilliardLoop<Real> reference = loop_of(discs, Real(Real(2) / 7));
  for (int i = 0; i < events; ++i) {
    if (loop.pass() != reference.pass()) std::fprintf(stderr, "compare_events: another disc\n");
  }
  const Vector2d exact = reference.position().cast<double>();
  Simulation simulation(scene_of(discs));
  Vector2d ours = Vector2d::Zero();
  simulation.advance_to(10 * events, [&](const Switch& event) {
    if (event.index == events - 1) ours = event.position;
  });
  print("relative error after a thousand events", "hybrid_sphere", discs.size(),
        (ours - exact).norm() / exact.norm());
  print("relative error after a thousand events", "billiard", discs.size(),
        (loop.position() - exact).norm() / exact.norm());
}

}  // namespace
}  // namespace hybrid_sphere::peers

int main() {
  std::puts("what,loop,regions,value");
  hybrid_sphere::peers::compare_costs_of_straight_paths();
  hybrid_sphere::peers::compare_costs_of_parabolas();
  hybrid_sphere::peers::compare_grazes();
  hybrid_sphere::peers::compare_errors();
}
