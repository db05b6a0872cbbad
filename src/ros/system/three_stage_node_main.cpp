#include <cstdio>
#include <string_view>

#include "cli/begin_program.hpp"
#include "cli/exit_code.hpp"
#include "ros/system/run_system.hpp"

namespace {

constexpr const char* usage =
    R"(Simulates a system with constraints that come and go, in real time: one of the catalogue of three_stage, or of a plugin.
Usage: three_stage_node _system:=NAME [NAME:=VALUE...]
       roslaunch hybrid_sphere plant.launch system:=NAME      the usual way

NAME is one of `three_stage list`, or the name of a plugin of the base class hybrid_sphere::SystemPlugin.
Private parameters, which may be given here (a leading underscore stands for the private ones):
  _accuracy:=A                wanted error relative to the scale of motion, default 1e-9
  _duration:=S                over which errors may add up to that, default: that of the system
  _rate:=HZ                   outputs in a second of simulated time, default 100
  _real_time_factor:=F        simulated seconds in one of wall time, default 1; 0: as fast as it can
  _paused:=true               time stands until ~pause or ~step
  _clock:=lead                this node publishes /clock; `follow`: it follows somebody else's
  _realtime_priority:=N       1 to 99: SCHED_FIFO and locked memory; default 0: none
  _world_frame:=NAME          default world
  __name:=NAME  __ns:=NAME    of the node
  FROM:=TO                    another name of a topic or service

Publishes ~joint_states ~state ~switch ~status /diagnostics /clock, and ~markers /tf of systems that have bodies;
listens to ~input; answers ~get_state ~reset ~pause ~step.
All topics, services and parameters with types, units and ranges: docs/three_stage_node.md.

Options:
  -h,--help                   Print this help message and exit

Exit code: 0 shut down, 2 usage, 3 system refused, 4 the computation could not go on.
)";

}  // namespace

int main(int argc, char** argv) {
  hybrid_sphere::cli::begin_program();
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--help" || argument == "-h") {
      if (std::fputs(usage, stdout) >= 0 && std::fflush(stdout) == 0) return hybrid_sphere::cli::done;
      std::perror("three_stage_node: standard output cannot be written");
      return hybrid_sphere::cli::could_not_go_on;
    }
  }
  return hybrid_sphere::ros_interface::run_system(argc, argv);
}
