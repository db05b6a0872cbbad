#include <cstdio>
#include <string_view>

#include "cli/begin_program.hpp"
#include "cli/exit_code.hpp"
#include "ros/node/run_simulator.hpp"

namespace {

constexpr const char* usage =
    R"(Simulates a sphere on ground that is smooth in some places and rough in others, in real time.
Usage: hybrid_sphere_node [NAME:=VALUE...]
       roslaunch hybrid_sphere sim.launch [scene:=SCENE]      the usual way: loads a scene, opens rviz

The scene is in a file, or in the private parameters, which override those of the file. They may be given
here (a leading underscore stands for the private ones):
  _scene_file:=SCENE          a scene of the package, such as paper, or the path of a scene file
  _rate:=HZ                   outputs in a second of simulated time, default 100
  _real_time_factor:=F        simulated seconds in one of wall time, default 1; 0: as fast as it can
  _paused:=true               time stands until ~pause or ~step
  _clock:=lead                this node publishes /clock; `follow`: it follows somebody else's
  _command_timeout:=S         after which a command is dropped, default 0.5; 0: it is held
  _realtime_priority:=N       1 to 99: SCHED_FIFO and locked memory; default 0: none
  _world_frame:=NAME          default world
  _sphere_frame:=NAME         default sphere
  __name:=NAME  __ns:=NAME    of the node
  FROM:=TO                    another name of a topic or service

Publishes ~pose ~twist ~odom ~state ~constraint_switch ~surface_map ~surface_markers ~markers ~status
/diagnostics /tf /clock;
listens to ~cmd_wrench ~surface_grid initialpose clicked_point;
answers ~set_surface_map ~get_surface_map ~set_initial_state ~set_state ~get_state ~kick ~reset
~pause ~step.
All topics, services and parameters with types, units and ranges: docs/ros_interface.md.

Options:
  -h,--help                   Print this help message and exit

Exit code: 0 shut down, 2 usage, 3 scene refused, 4 the computation could not go on.
)";

}  // namespace

int main(int argc, char** argv) {
  hybrid_sphere::cli::begin_program();
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--help" || argument == "-h") {
      if (std::fputs(usage, stdout) >= 0 && std::fflush(stdout) == 0) return hybrid_sphere::cli::done;
      std::perror("hybrid_sphere_node: standard output cannot be written");
      return hybrid_sphere::cli::could_not_go_on;
    }
  }
  return hybrid_sphere::ros_interface::run_simulator(argc, argv);
}
