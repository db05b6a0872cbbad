#include "cli/study_processes.hpp"

#include <sched.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <vector>

namespace hybrid_sphere::cli::studies {
namespace {

constexpr const char* watched = "HYBRID_SPHERE_WATCHED";

void set_unless_set(const char* name, const char* value) { setenv(name, value, 0); }

}  // namespace

void run_under_mpirun(int processes, int argc, char** argv) {
  if (isatty(STDERR_FILENO) != 0) set_unless_set(watched, "1");
  // In a container everybody is root, and nobody may read the memory of another process.
  if (geteuid() == 0) {
    set_unless_set("OMPI_ALLOW_RUN_AS_ROOT", "1");
    set_unless_set("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
  }
  set_unless_set("OMPI_MCA_btl_vader_single_copy_mechanism", "none");
  set_unless_set("HWLOC_HIDE_ERRORS", "2");  // of a root without /sys
  std::vector<std::string> words{"mpirun", "--oversubscribe",         "--bind-to",     "none",
                                 "-n",     std::to_string(processes), "/proc/self/exe"};
  std::string self(4096, '\0');
  const ssize_t length = readlink("/proc/self/exe", self.data(), self.size());
  if (length > 0) words.back() = self.substr(0, static_cast<std::size_t>(length));
  for (int i = 1; i < argc; ++i) words.emplace_back(argv[i]);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execvp("mpirun", arguments.data());
}

int cores() {
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
  return CPU_COUNT(&set);
}

bool is_watched() { return isatty(STDERR_FILENO) != 0 || std::getenv(watched) != nullptr; }

}  // namespace hybrid_sphere::cli::studies
