// The same scenes with hybrid_sphere and with every simulator that was found when this was built, in one
// run: errors against a reference in 113 bits, and wall time.
//
// What is timed: the motion from the initial state to the last output and the storing of the outputs, by
// std::chrono::steady_clock; not the setting up. hybrid_sphere computes the whole state with the
// orientation, as `simulate` does, once at the outputs that all are asked for (ratio_to_hybrid_sphere) and
// once at every step of the row it is compared with (ratio_at_every_step). After a first
// run the fastest of three or more counts; runs of less than 5 ms are repeated and their mean is a run; a
// row that would take long is run once, or not at all (--limit).
//
// The errors are the largest over the outputs, of the position in the plane, relative to the way that the
// sphere has come at the end, and of linear and angular velocity together, as the square root of the
// kinetic energy of the difference relative to the largest kinetic energy of the motion. Height and
// orientation are left out.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iostream>

#include "hybrid_sphere/scene/read_scene.hpp"
#include "measure.hpp"
#include "reference.hpp"
#include "report.hpp"

namespace {

using namespace hybrid_sphere;
using namespace hybrid_sphere::peers;

struct Plan {
  const char* scene;
  double interval;  // [s]
  int outputs;
};

// All intervals are whole numbers of steps of every size.
constexpr Plan plans[] = {{"paper", 0.03, 100},  {"long_rolling", 0.3, 334}, {"incline", 0.03, 100},
                          {"strips", 0.03, 150}, {"small", 0.03, 100},       {"large", 0.03, 100},
                          {"fast", 0.03, 100}};

Task make_task(const Plan& plan, bool quick) {
  Task task;
  task.name = plan.scene;
  task.scene = scene::read_scene_file(std::string(PEERS_SCENES) + '/' + plan.scene + ".yaml");
  task.interval = plan.interval;
  task.outputs = quick ? plan.outputs / 5 : plan.outputs;
  return task;
}

/// @return  whether the reference agrees with the solutions in thirty digits
bool reference_holds() {
  bool holds = true;
  for (const char* name : {"o01_paper", "o07_rough_smooth_rough", "slope_strips"}) {
    const double error = check_reference(std::string(PEERS_ORACLE) + '/' + name);
    std::cerr << "reference of " << name << ": off by " << error << " of the tolerance\n";
    holds = holds && error <= 1;
  }
  return holds;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("hybrid_sphere beside other simulators: error and cost in the same scenes");
  Limits limits;
  std::string csv;
  std::string only_scene;
  std::string only_peer;
  app.add_flag("--quick", limits.quick,
               "one run of one step size, a fifth of the time: whether all of it works");
  app.add_option("--limit", limits.seconds, "wall time for a row [s]")->capture_default_str();
  app.add_option("--csv", csv, "file for the rows; standard output without it");
  app.add_option("--scene", only_scene, "this scene alone");
  app.add_option("--peer", only_peer, "peers whose name contains this");
  CLI11_PARSE(app, argc, argv);
  try {
    if (!reference_holds()) return 1;
    std::vector<std::unique_ptr<Peer>> peers = found_peers();
    peers.erase(
        std::remove_if(peers.begin(), peers.end(),
                       [&](const auto& peer) { return peer->name().find(only_peer) == std::string::npos; }),
        peers.end());
    std::vector<Row> rows;
    for (const Plan& plan : plans) {
      if (!only_scene.empty() && only_scene != plan.scene) continue;
      std::cerr << plan.scene << " ...\n";
      for (Row& row : compare(make_task(plan, limits.quick), peers, limits)) rows.push_back(std::move(row));
    }
    write_table(rows, std::cerr);
    write_claim(rows, std::cerr);
    if (csv.empty()) {
      write_csv(rows, std::cout);
    } else {
      std::ofstream file(csv);
      write_csv(rows, file);
      if (!file.flush()) throw std::runtime_error(csv + " cannot be written");
    }
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "compare_peers: " << error.what() << '\n';
    return 1;
  }
}
