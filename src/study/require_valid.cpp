#include <algorithm>
#include <boost/random/sobol.hpp>
#include <stdexcept>

#include "study/sampler.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::study {
namespace {

constexpr std::uint64_t max_design_runs = std::uint64_t{1} << 53;  // all of them are numbers of binary64

[[noreturn]] void refuse(const std::string& what, const std::string& allowed) {
  throw std::invalid_argument(text::refusal(what, allowed));
}

void require_variables(const Design& design) {
  if (design.variables.empty()) refuse("variables: none", "at least one");
  std::vector<std::string> sorted = design.variables;
  std::sort(sorted.begin(), sorted.end());
  const auto repeated = std::adjacent_find(sorted.begin(), sorted.end());
  if (repeated != sorted.end()) refuse("variables: " + *repeated + " twice", "each variable once");
}

void require_dimensions(const Design& design) {
  constexpr std::size_t all = boost::random::default_sobol_table::max_dimension;
  const std::size_t most = design.saltelli ? all / 2 : all;
  if (design.sampling != Sampling::sobol || design.variables.size() <= most) return;
  refuse("variables: " + std::to_string(design.variables.size()) + " with the sampling sobol",
         "at most " + std::to_string(most) + (design.saltelli ? " for Sobol' indices" : "") +
             "; the samplings random and latin_hypercube have any number");
}

void require_levels(const Design& design) {
  if (design.saltelli) refuse("sampling: grid for Sobol' indices", "random, latin_hypercube, sobol");
  if (design.levels.size() != design.variables.size()) {
    refuse("levels: " + std::to_string(design.levels.size()) + " numbers",
           std::to_string(design.variables.size()) + ", one of each variable");
  }
  std::uint64_t product = 1;
  for (std::size_t i = 0; i < design.levels.size(); ++i) {
    const std::uint64_t level = design.levels[i];
    if (level == 0) refuse("levels: 0 of " + design.variables[i], "at least 1");
    if (level > max_design_runs / product) {
      refuse("levels: a product above " + std::to_string(max_design_runs), "at most so many combinations");
    }
    product *= level;
  }
  if (product != design.runs) {
    refuse("runs: " + std::to_string(design.runs) + " with the sampling grid",
           std::to_string(product) + ", the product of the levels");
  }
}

void require_whole_groups(const Design& design) {
  const std::uint64_t size = design.variables.size() + 2;
  const std::uint64_t rest = design.runs % size;
  if (rest == 0) return;
  const std::uint64_t below = design.runs - rest;
  std::string near = below == 0 ? "" : std::to_string(below);
  if (below + size <= max_design_runs) near += (near.empty() ? "" : " or ") + std::to_string(below + size);
  refuse("runs: " + std::to_string(design.runs) + " for Sobol' indices",
         "a multiple of " + std::to_string(size) + ", the number of variables and 2, such as " + near);
}

}  // namespace

void require_valid(const Design& design) {
  require_variables(design);
  if (design.runs == 0 || design.runs > max_design_runs) {
    refuse("runs: " + std::to_string(design.runs), "1 to " + std::to_string(max_design_runs));
  }
  if (design.sampling == Sampling::grid) require_levels(design);
  require_dimensions(design);
  if (design.saltelli) require_whole_groups(design);
}

}  // namespace hybrid_sphere::study
