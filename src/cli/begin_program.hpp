#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <csignal>

namespace hybrid_sphere::cli {

/// Called first by every program, so that what cannot be written is an error that is told, never lost:
/// * a standard stream that is closed stays so for reading and writing, but no file that is opened later
///   takes its place;
/// * a pipe whose reader has gone, and a file at the limit of its size, fail with EPIPE and EFBIG instead of
///   ending the program by SIGPIPE and SIGXFSZ.
inline void begin_program() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    if (fcntl(stream, F_GETFD) != -1) continue;
    // The lowest descriptor that is free: this one. The wrong way round, so that its use fails as before.
    if (open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY) != stream) return;
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace hybrid_sphere::cli
