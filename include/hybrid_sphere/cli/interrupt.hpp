#pragma once

#include <csignal>

namespace hybrid_sphere::cli {

/// While one lives, the first SIGINT (Ctrl-C) is noted instead of ending the process; the second one ends it
/// as usual. Where SIGINT is ignored it stays so. There is one at a time.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  bool seen() const;

 private:
  struct sigaction before_;
};

}  // namespace hybrid_sphere::cli
