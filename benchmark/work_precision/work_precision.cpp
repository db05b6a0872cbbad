// Error against cost of every method, one line of CSV for each setting of its dial:
//   scene,method,setting,error,evaluations,nanoseconds,relative
// setting: solver.accuracy, or solver.step of the methods of fixed step. error: the largest of place,
// velocity, angular velocity and orientation over all outputs (one half way between two switches), relative
// to the scale of motion: the way, the greatest speed, the angle turned. evaluations: right-hand sides.
// nanoseconds: wall time of a simulated second, the outputs with it, the shortest of some runs. relative:
// that to auto at the same accuracy (for a step: at 1e-9).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "scenes.hpp"

namespace {

using namespace hybrid_sphere;
using scene::Solver;
using work_precision::Problem;

struct Result {
  double error = std::numeric_limits<double>::quiet_NaN();
  unsigned long long evaluations = 0;
  double nanoseconds = 0;  // a simulated second
};

double distance(const Quaterniond& a, const Quaterniond& b) {
  return 2 * std::min((a.coeffs() - b.coeffs()).norm(), (a.coeffs() + b.coeffs()).norm());
}

class Errors {
 public:
  explicit Errors(const Problem& problem) : radius_(problem.scene.sphere.radius) {
    Vector2d last = problem.scene.initial_state.position;
    double time = 0;
    see(problem.scene.initial_state.velocity, problem.scene.initial_state.angular_velocity);
    for (const State& state : problem.truth) {
      way_ += (state.position - last).norm();
      turned_ += state.twist.angular_velocity.norm() * (state.time - time);
      see(state.twist.velocity, state.twist.angular_velocity);
      last = state.position;
      time = state.time;
    }
  }
  void add(const State& found, const State& truth) {
    const Vector3d spin = found.twist.angular_velocity - truth.twist.angular_velocity;
    for (const double error :
         {(found.position - truth.position).norm() / way_,
          (found.twist.velocity - truth.twist.velocity).norm() / speed_, radius_ * spin.norm() / speed_,
          distance(found.orientation, truth.orientation) / std::max(1.0, turned_)}) {
      worst_ = std::max(worst_, std::isnan(error) ? HUGE_VAL : error);
    }
  }
  double worst() const { return worst_; }

 private:
  void see(const Vector2d& velocity, const Vector3d& spin) {
    speed_ = std::max({speed_, velocity.norm(), radius_ * spin.norm()});
  }

  double radius_;
  double way_ = 0;
  double speed_ = 0;
  double turned_ = 0;
  double worst_ = 0;
};

Result run_once(const Problem& problem, const scene::Scene& scene) {
  Result result;
  Simulation simulation(scene);
  Errors errors(problem);
  std::vector<State> found;
  found.reserve(problem.truth.size());
  const auto begin = std::chrono::steady_clock::now();
  try {
    for (const State& truth : problem.truth) {
      simulation.advance_to(truth.time, [](const Switch&) {});
      found.push_back(simulation.state());
    }
  } catch (const HaltedError&) {
    return result;
  }
  const std::chrono::duration<double, std::nano> cost = std::chrono::steady_clock::now() - begin;
  for (std::size_t i = 0; i < found.size(); ++i) errors.add(found[i], problem.truth[i]);
  result.error = errors.worst();
  result.evaluations = simulation.evaluations();
  result.nanoseconds = cost.count() / problem.truth.back().time;
  return result;
}

Result run(const Problem& problem, const Solver& solver) {
  constexpr double long_run = 2e7;  // [ns]
  scene::Scene scene = problem.scene;
  scene.solver = solver;
  Result result = run_once(problem, scene);
  double spent = result.nanoseconds * problem.truth.back().time;
  for (int i = 0; i < 50 && spent < long_run; ++i) {
    const Result again = run_once(problem, scene);
    result.nanoseconds = std::min(result.nanoseconds, again.nanoseconds);
    spent += again.nanoseconds * problem.truth.back().time;
  }
  return result;
}

void print(const Problem& problem, const char* method, double setting, const Result& result, double beside) {
  std::printf("%s,%s,%g,%.3g,%llu,%.4g,%.4g\n", problem.name.c_str(), method, setting, result.error,
              result.evaluations, result.nanoseconds, result.nanoseconds / beside);
  std::fflush(stdout);
}

}  // namespace

int main() {
  std::puts("scene,method,setting,error,evaluations,nanoseconds,relative");
  for (const Problem& problem : work_precision::problems()) {
    for (const scene::MethodName& named : scene::method_names) {
      const Solver kind{named.method, 1e-9, 1e-3};
      if (named.method == Solver::Method::exact) continue;
      if (kind.has_fixed_step()) {
        const double beside = run(problem, Solver{}).nanoseconds;
        for (const double step : {0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5}) {
          print(problem, named.name, step, run(problem, {named.method, 1e-9, step}), beside);
        }
        continue;
      }
      for (const double accuracy : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12}) {
        const double beside = run(problem, {Solver::Method::automatic, accuracy, 1e-3}).nanoseconds;
        print(problem, named.name, accuracy, run(problem, {named.method, accuracy, 1e-3}), beside);
      }
    }
  }
}
