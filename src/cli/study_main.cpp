#include <exception>
#include <iostream>

#include "cli/arguments.hpp"
#include "cli/begin_program.hpp"
#include "cli/study_processes.hpp"
#include "cli/study_run.hpp"

int main(int argc, char** argv) {
  using namespace hybrid_sphere::cli;
  using hybrid_sphere::study::Team;
  begin_program();
  const bool speaks = !Team::is_under_mpirun() || Team::is_first();
  std::ostream silent(nullptr);
  std::ostream& out = speaks ? std::cout : silent;
  std::ostream& err = speaks ? std::cerr : silent;
  const studies::Parsed parsed = studies::parse_options(argc, argv, out, err);
  if (!parsed.options) return parsed.exit_code;
  const studies::Options& options = *parsed.options;
  if (options.scene) return studies::write_scene(options, out, err);
  if (!Team::is_under_mpirun()) {
    int exit_code = done;
    const int processes = studies::processes_for(options, err, exit_code);
    if (exit_code != done) return exit_code;
    if (processes > 1) {
      studies::run_under_mpirun(processes, argc, argv);
      write_error("study", "mpirun cannot be started: one process computes; Debian has it in openmpi-bin",
                  err);
    }
  }
  try {
    Team team;
    try {
      return studies::run(options, team, out, err);
    } catch (const std::exception& error) {
      write_error("study", error.what(), std::cerr);
      team.abort(could_not_go_on);
    }
  } catch (const std::exception& error) {
    write_error("study", error.what(), std::cerr);
  }
  return could_not_go_on;
}
