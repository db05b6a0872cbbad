// What the dial delivers: every scene of test/data with a solution in high precision, every method with a
// control of its error; with a method's name that method alone. CSV, one line for each accuracy:
//   method,accuracy,error,over,other_switches,within_accuracy,halted,evaluations,scene
// error: the worst of all outputs, in units of the accuracy asked for; over: scenes in which it is above 1.
// other_switches: scenes with a number of switches that is wrong; within_accuracy: where an initial velocity
// that is off by the accuracy would change it as well. halted: scenes that should not. scene: of the worst
// error.
#include <algorithm>
#include <cstdio>
#include <string>

#include "support/dial.hpp"

namespace {

using hybrid_sphere::scene::Solver;
using hybrid_sphere::testing::Delivered;
using hybrid_sphere::testing::SolvedScene;

struct Total {
  double worst = 0;
  std::string name;
  int over = 0;
  int other_switches = 0;
  int hanging = 0;
  int halted = 0;
  unsigned long long evaluations = 0;

  void add(const SolvedScene& solved, const Delivered& delivered) {
    evaluations += delivered.evaluations;
    halted += delivered.halt.empty() ? 0 : 1;
    other_switches += delivered.other_switches && !delivered.hangs_on_less ? 1 : 0;
    hanging += delivered.hangs_on_less ? 1 : 0;
    if (!delivered.halt.empty() || delivered.other_switches) return;
    over += delivered.worst > 1 ? 1 : 0;
    if (delivered.worst <= worst) return;
    worst = delivered.worst;
    name = solved.name;
  }
};

}  // namespace

int main(int argc, char** argv) {
  const std::vector<SolvedScene> scenes = hybrid_sphere::testing::solved_scenes();
  std::puts("method,accuracy,error,over,other_switches,within_accuracy,halted,evaluations,scene");
  for (const auto& named : hybrid_sphere::scene::method_names) {
    if (argc > 1 && named.name != std::string(argv[1])) continue;
    if (Solver{named.method, 1, 1}.has_fixed_step() || named.method == Solver::Method::exact) continue;
    for (const double accuracy : {1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-9, 1e-10, 1e-12}) {
      Total total;
      for (const SolvedScene& solved : scenes) {
        total.add(solved, hybrid_sphere::testing::deliver(solved, {named.method, accuracy, 1e-3}));
      }
      std::printf("%s,%g,%.3g,%d,%d,%d,%d,%llu,%s\n", named.name, accuracy, total.worst, total.over,
                  total.other_switches, total.hanging, total.halted, total.evaluations, total.name.c_str());
      std::fflush(stdout);
    }
  }
}
