// What the dial delivers and what it costs: every scene of test/data with a solution in high precision, every
// method with a control of its error. One line for each accuracy; with a method's name that method alone.
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
  double seconds = 0;

  void add(const SolvedScene& solved, const Delivered& delivered) {
    evaluations += delivered.evaluations;
    seconds += delivered.seconds;
    halted += delivered.halt.empty() ? 0 : 1;
    other_switches += delivered.other_switches && !delivered.hangs_on_less ? 1 : 0;
    hanging += delivered.hangs_on_less ? 1 : 0;
    if (!delivered.halt.empty() || delivered.other_switches) return;
    over += delivered.worst > 1 ? 1 : 0;
    if (delivered.worst <= worst) return;
    worst = delivered.worst;
    name = solved.name + ", " + delivered.where;
  }
};

}  // namespace

int main(int argc, char** argv) {
  const std::vector<SolvedScene> scenes = hybrid_sphere::testing::solved_scenes();
  std::printf("%zu scenes; error: the worst of all outputs, in units of the accuracy asked for\n",
              scenes.size());
  for (const auto& named : hybrid_sphere::scene::method_names) {
    if (argc > 1 && named.name != std::string(argv[1])) continue;
    if (Solver{named.method, 1, 1}.has_fixed_step() || named.method == Solver::Method::exact) continue;
    for (const double accuracy : {1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-9, 1e-10, 1e-12}) {
      Total total;
      for (const SolvedScene& solved : scenes) {
        total.add(solved, hybrid_sphere::testing::deliver(solved, {named.method, accuracy, 1e-3}));
      }
      std::printf(
          "%-12s %5.0e  error %8.2e  over %3d  other switches %2d (within the accuracy %2d)  halted %2d  "
          "evaluations %10llu  "
          "%6.2f s  (%s)\n",
          named.name, accuracy, total.worst, total.over, total.other_switches, total.hanging, total.halted,
          total.evaluations, total.seconds, total.name.c_str());
      std::fflush(stdout);
    }
  }
}
