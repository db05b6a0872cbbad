#include <iostream>

#include "cli/begin_program.hpp"
#include "cli/three_stage_run.hpp"

int main(int argc, char** argv) {
  using namespace hybrid_sphere::cli::three_stage;
  hybrid_sphere::cli::begin_program();
  const Parsed parsed = parse_options(argc, argv, std::cout, std::cerr);
  return parsed.options ? run(*parsed.options, std::cout, std::cerr) : parsed.exit_code;
}
