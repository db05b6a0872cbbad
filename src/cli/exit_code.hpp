#pragma once

namespace hybrid_sphere::cli {

/// Exit codes of the programs.
enum ExitCode : int {
  done = 0,
  usage = 2,            ///< an option is refused
  refused = 3,          ///< the scene or the system is refused
  could_not_go_on = 4,  ///< the motion or a table ended before its end
  by_signal = 128       ///< and the number of the signal that ended the run: 130 by Ctrl-C, 143 by `kill`
};

}  // namespace hybrid_sphere::cli
