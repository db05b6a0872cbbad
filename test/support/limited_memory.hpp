#pragma once

#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <new>
#include <string>

#include "scene/tree.hpp"

namespace hybrid_sphere::testing {

inline std::size_t address_space() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

/// The most memory that the program has had so far.
inline long peak_memory_kb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

/// "accepted", the message of the refusal, or that the memory is not enough.
inline std::string outcome(const std::function<void()>& read) {
  try {
    read();
    return "accepted";
  } catch (const scene::SceneError& error) {
    return error.what();
  } catch (const std::bad_alloc&) {
    return "out of memory";
  }
}

/// The same in a child process whose address space may grow by so many bytes. Not under the address
/// sanitizer.
inline std::string outcome_within(std::size_t memory, const std::function<void()>& read) {
  int ends[2];
  if (pipe(ends) != 0) return "no pipe";
  const pid_t child = fork();
  if (child == 0) {
    malloc_trim(0);
    const rlim_t most = address_space() + memory;
    const rlimit limit{most, most};
    setrlimit(RLIMIT_AS, &limit);
    const std::string text = outcome(read);
    _exit(write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size()) ? 0 : 1);
  }
  close(ends[1]);
  std::string text(4096, '\0');
  const ssize_t size = ::read(ends[0], text.data(), text.size());
  close(ends[0]);
  text.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? text : "ended by signal " + std::to_string(WTERMSIG(status));
}

}  // namespace hybrid_sphere::testing
