// The general engine on every system of the catalogue.
//   equations/NAME   one right-hand side of stage 3, with derivatives by hand and with automatic ones:
//                    nanoseconds of each, and their ratio
//   run/NAME/1e-A    a whole run at that accuracy: steps, right-hand sides, and the deviation from the known
//                    solution relative to the scale of motion, where there is one
//   sleigh/1e-A      a whole run of Chaplygin's sleigh beside a program for it alone, with that tolerance:
//                    a matrix of 4 x 4, solved by Eigen, and Boost's Runge-Kutta-Fehlberg of order 7(8);
//                    microseconds of each, their ratio, the errors of both at the end, and the ratio to that
//                    program with the tolerance of a power of ten at which its error is no larger than the
//                    engine's; 0: there is none
//   chain/N          one right-hand side of a plane chain of N links with a knife edge at its end, by a mass
//                    matrix: microseconds
#include <benchmark/benchmark.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>
#include <type_traits>

#include "catalogue/catalogue.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"
#include "mechanics/constrained_motion.hpp"

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"  // odeint copies steppers that have taken no step
#endif
#include <boost/numeric/odeint.hpp>

namespace {

using namespace hybrid_sphere::mechanics;

double nanoseconds(ConstrainedMotion& motion, const State& state) {
  constexpr int evaluations = 1000;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < evaluations; ++i) {
    motion.evaluate_stage(state.time, state.q, state.v);
    benchmark::DoNotOptimize(motion.acceleration().data());
  }
  const std::chrono::duration<double, std::nano> elapsed = std::chrono::steady_clock::now() - start;
  return elapsed.count() / evaluations;
}

void equations(benchmark::State& state, const catalogue::Entry& entry) {
  const catalogue::Example example = entry.build(catalogue::Values(entry.parameters));
  const Solution solution = solve(example.model, example.initial, entry.duration);
  const State where = solution.at(solution.end());
  ConstrainedMotion automatic(example.model);
  ConstrainedMotion by_hand(example.by_hand);
  for (ConstrainedMotion* motion : {&automatic, &by_hand}) {
    motion->set_active(where.active);
    motion->evaluate_stage(where.time, where.q, where.v);
  }
  double sum_automatic = 0;
  double sum_by_hand = 0;
  for (auto _ : state) {
    sum_automatic += nanoseconds(automatic, where);
    sum_by_hand += nanoseconds(by_hand, where);
  }
  const auto rounds = static_cast<double>(state.iterations());
  state.counters["automatic_ns"] = sum_automatic / rounds;
  state.counters["by_hand_ns"] = sum_by_hand / rounds;
  state.counters["ratio"] = sum_automatic / sum_by_hand;
}

/// Largest deviation of q from the known solution at 100 instants, relative to its largest component.
double deviation(const catalogue::Example& example, const Solution& solution) {
  constexpr int instants = 100;
  double largest = 0;
  double size = 0;
  for (int i = 0; i <= instants; ++i) {
    const double t = solution.begin() + (solution.end() - solution.begin()) * i / instants;
    const auto known = example.known ? example.known(t) : std::nullopt;
    if (!known) continue;
    size = std::max(size, known->q.lpNorm<Eigen::Infinity>());
    largest = std::max(largest, (solution.at(t).q - known->q).lpNorm<Eigen::Infinity>());
  }
  return size > 0 ? largest / size : 0;
}

void run(benchmark::State& state, const catalogue::Entry& entry, double accuracy) {
  const catalogue::Example example = entry.build(catalogue::Values(entry.parameters));
  Options options;
  options.accuracy = accuracy;
  for (auto _ : state) {
    benchmark::DoNotOptimize(solve(example.model, example.initial, entry.duration, options).end());
  }
  const Solution solution = solve(example.model, example.initial, entry.duration, options);
  state.counters["steps"] = static_cast<double>(solution.steps());
  state.counters["evaluations"] = static_cast<double>(solution.evaluations());
  state.counters["deviation"] = deviation(example, solution);
}

using Sleigh = std::array<double, 6>;  // q and v

/// M v' - C^T lambda = h, C v' = gamma of the catalogue's sleigh, by hand.
struct SleighEquations {
  double m, I, a;
  bool is_held;
  void operator()(const Sleigh& x, Sleigh& rate, double /*t*/) const {
    const double c = std::cos(x[2]), s = std::sin(x[2]), w = x[5];
    Eigen::Matrix4d matrix;
    matrix << m, 0, -m * a * s, s, 0, m, m * a * c, -c, -m * a * s, m * a * c, I + m * a * a, 0, -s, c, 0, 0;
    Eigen::Vector4d right(m * a * w * w * c, m * a * w * w * s, 0, (x[3] * c + x[4] * s) * w);
    if (!is_held) {
      matrix.row(3) << 0, 0, 0, 1;
      right[3] = 0;
    }
    const Eigen::Vector4d solution = matrix.partialPivLu().solve(right);
    for (std::size_t i = 0; i < 3; ++i) {
      rate[i] = x[3 + i];
      rate[3 + i] = solution[static_cast<Index>(i)];
    }
  }
  /// The impulse that applies the blade.
  void hold(Sleigh& x) {
    is_held = true;
    const double c = std::cos(x[2]), s = std::sin(x[2]);
    Eigen::Matrix4d matrix;
    matrix << m, 0, -m * a * s, s, 0, m, m * a * c, -c, -m * a * s, m * a * c, I + m * a * a, 0, -s, c, 0, 0;
    const Eigen::Vector4d change = matrix.partialPivLu().solve(Eigen::Vector4d(0, 0, 0, x[3] * s - x[4] * c));
    for (std::size_t i = 0; i < 3; ++i) x[3 + i] += change[static_cast<Index>(i)];
  }
};

Sleigh sleigh_alone(const catalogue::Entry& entry, const Initial& initial, double accuracy) {
  namespace odeint = boost::numeric::odeint;
  const catalogue::Values values(entry.parameters);
  SleighEquations equations{values["m"], values["I"], values["a"], false};
  const double switch_time = values["t_switch"];
  Sleigh x{initial.q[0], initial.q[1], initial.q[2], initial.v[0], initial.v[1], initial.v[2]};
  using Method = odeint::runge_kutta_fehlberg78<Sleigh>;
  const auto method = odeint::make_controlled<Method>(accuracy, accuracy);
  odeint::integrate_adaptive(method, equations, x, 0.0, switch_time, 0.01);
  equations.hold(x);
  odeint::integrate_adaptive(method, equations, x, switch_time, entry.duration, 0.01);
  return x;
}

double error_of(const Sleigh& end, const Vector& known) {
  return (Eigen::Vector3d(end[0], end[1], end[2]) - known).norm();
}

/// The tolerance at which the program alone has no more than this error; 0: none.
double tolerance_for(const catalogue::Entry& entry, const Initial& initial, const Vector& known,
                     double error) {
  for (double tolerance = 1e-3; tolerance > 1e-15; tolerance /= 10) {
    if (error_of(sleigh_alone(entry, initial, tolerance), known) <= error) return tolerance;
  }
  return 0;
}

void sleigh(benchmark::State& state, const catalogue::Entry& entry, double accuracy) {
  const catalogue::Example example = entry.build(catalogue::Values(entry.parameters));
  Options options;
  options.accuracy = accuracy;
  const auto microseconds = [](const auto& run) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 20; ++i) run();
    return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count() / 20;
  };
  const Vector known = example.known(entry.duration)->q;
  const Vector found = solve(example.model, example.initial, entry.duration, options).at(entry.duration).q;
  const double as_exact = tolerance_for(entry, example.initial, known, (found - known).norm());
  double of_engine = 0;
  double alone = 0;
  double alone_as_exact = 0;
  for (auto _ : state) {
    of_engine += microseconds([&] {
      benchmark::DoNotOptimize(solve(example.model, example.initial, entry.duration, options).end());
    });
    alone += microseconds([&] { benchmark::DoNotOptimize(sleigh_alone(entry, example.initial, accuracy)); });
    if (as_exact == 0) continue;
    alone_as_exact +=
        microseconds([&] { benchmark::DoNotOptimize(sleigh_alone(entry, example.initial, as_exact)); });
  }
  const auto rounds = static_cast<double>(state.iterations());
  state.counters["engine_us"] = of_engine / rounds;
  state.counters["alone_us"] = alone / rounds;
  state.counters["ratio"] = of_engine / alone;
  state.counters["error"] = (found - known).norm();
  state.counters["error_alone"] = error_of(sleigh_alone(entry, example.initial, accuracy), known);
  state.counters["ratio_as_exact"] = as_exact > 0 ? of_engine / alone_as_exact : 0;
}

/// Links of unit length, a unit mass at each joint, angles from the vertical.
template <int n>
void chain(benchmark::State& state) {
  typename System<n>::CoordinateNames names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = "a" + std::to_string(i);
  const auto mass = [](const auto&, const auto& q) {
    using std::cos;
    Eigen::Matrix<std::decay_t<decltype(q[0])>, n, n> matrix;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j <= i; ++j) matrix(i, j) = matrix(j, i) = (n - i) * cos(q[i] - q[j]);
    }
    return matrix;
  };
  const auto potential = [](const auto&, const auto& q) {
    using std::cos;
    std::decay_t<decltype(q[0])> sum(0);
    for (int i = 0; i < n; ++i) sum -= (n - i) * 9.81 * cos(q[i]);
    return sum;
  };
  System<n> system(names, with_mass_matrix(mass, potential));
  const auto across = [](const auto&, const auto& q, const auto& v) {
    using std::cos;
    std::decay_t<decltype(q[0] * v[0])> sum(0);
    for (int i = 0; i < n; ++i) sum += cos(q[i] - q[n - 1]) * v[i];
    return sum;
  };
  system.constrain("knife edge", across, always());
  State where;
  where.q = where.v = Vector::Zero(n);
  for (int i = 0; i < n; ++i) {
    where.q[i] = std::sin(1.7 * i);
    where.v[i] = std::cos(2.3 * i);
  }
  ConstrainedMotion motion(system);
  motion.set_active({0});
  double sum = 0;
  for (auto _ : state) sum += nanoseconds(motion, where);
  state.counters["us"] = sum / static_cast<double>(state.iterations()) / 1000;
}

}  // namespace

int main(int argc, char** argv) {
  for (const catalogue::Entry& entry : catalogue::entries()) {
    benchmark::RegisterBenchmark(("equations/" + entry.name).c_str(),
                                 [&entry](benchmark::State& state) { equations(state, entry); });
    for (const auto& [name, accuracy] :
         {std::pair("1e-3", 1e-3), {"1e-6", 1e-6}, {"1e-9", 1e-9}, {"1e-12", 1e-12}}) {
      benchmark::RegisterBenchmark(
          ("run/" + entry.name + "/" + name).c_str(),
          [&entry, accuracy = accuracy](benchmark::State& state) { run(state, entry, accuracy); });
      if (entry.name != "chaplygin_sleigh") continue;
      benchmark::RegisterBenchmark(
          (std::string("sleigh/") + name).c_str(),
          [&entry, accuracy = accuracy](benchmark::State& state) { sleigh(state, entry, accuracy); });
    }
  }
  benchmark::RegisterBenchmark("chain/7", chain<7>);
  benchmark::RegisterBenchmark("chain/12", chain<12>);
  benchmark::RegisterBenchmark("chain/22", chain<22>);
  benchmark::RegisterBenchmark("chain/42", chain<42>);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
