#include "study/samples.hpp"

#include <variant>

namespace hybrid_sphere::study {

Design design_of(const Study& study) {
  Design design;
  design.sampling = study.sampling;
  design.seed = study.seed;
  design.runs = study.runs;
  for (const Variable& variable : study.variables) {
    design.variables.push_back(variable.path);
    design.levels.push_back(variable.levels);
  }
  design.saltelli = study.sensitivity;
  return design;
}

Samples::Samples(const Study& study) : sampler_(design_of(study)), correlations_(study.correlations) {
  for (const Variable& variable : study.variables) distributions_.push_back(variable.distribution);
  // Correlated variables are sums of independent standard normal ones.
  for (const Correlation& correlation : correlations_) {
    for (const std::size_t i : correlation.variables) {
      means_.push_back(std::get<Normal>(study.variables[i].distribution).mean);
      distributions_[i] = Normal{0, 1};
    }
  }
}

void Samples::values(std::uint64_t first, std::uint64_t count, double* out) const {
  sampler_.points(first, count, out);
  std::vector<double> sums;
  for (std::uint64_t run = 0; run < count; ++run) {
    double* const point = out + run * distributions_.size();
    for (std::size_t j = 0; j < distributions_.size(); ++j) point[j] = quantile(distributions_[j], point[j]);
    const double* mean = means_.data();
    for (const Correlation& correlation : correlations_) {
      const std::size_t size = correlation.variables.size();
      sums.assign(mean, mean + size);
      for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t k = 0; k <= i; ++k) {
          sums[i] += correlation.lower[i * size + k] * point[correlation.variables[k]];
        }
      }
      for (std::size_t i = 0; i < size; ++i) point[correlation.variables[i]] = sums[i];
      mean += size;
    }
  }
}

const char* to_string(Sampling sampling) {
  switch (sampling) {
    case Sampling::random: return "random";
    case Sampling::latin_hypercube: return "latin_hypercube";
    case Sampling::sobol: return "sobol";
    case Sampling::grid: return "grid";
  }
  return "";
}

}  // namespace hybrid_sphere::study
