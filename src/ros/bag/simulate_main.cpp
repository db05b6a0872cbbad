#include <dlfcn.h>

#include <iostream>

#include "cli/begin_program.hpp"
#include "cli/run.hpp"

namespace {

using namespace hybrid_sphere::cli;

/// From the library that knows ROS, which only a run with a bag loads: its own libraries take several times
/// as long to load as all the rest. Null, with the reason on standard error, where it cannot be loaded.
const BagFormat* load_bag_format() {
  void* library = dlopen("libhybrid_sphere_bag.so", RTLD_NOW | RTLD_LOCAL);
  void* function = library == nullptr ? nullptr : dlsym(library, "hybrid_sphere_bag_format");
  if (function == nullptr) {
    std::cerr << "simulate: --bag: " << dlerror() << '\n';
    return nullptr;
  }
  return reinterpret_cast<const BagFormat* (*)()>(function)();
}

}  // namespace

/// `simulate` as in src/cli/simulate_main.cpp, with bags.
int main(int argc, char** argv) {
  begin_program();
  const Parsed parsed = parse_options(argc, argv, std::cout, std::cerr);
  if (!parsed.options) return parsed.exit_code;
  if (parsed.options->bag.empty()) return run(*parsed.options, std::cout, std::cerr);
  const BagFormat* bags = load_bag_format();
  return bags == nullptr ? could_not_go_on : run(*parsed.options, std::cout, std::cerr, bags);
}
