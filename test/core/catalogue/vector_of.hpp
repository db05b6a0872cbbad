#pragma once

#include <yaml-cpp/yaml.h>

#include "hybrid_sphere/mechanics/model.hpp"

namespace hybrid_sphere::mechanics::catalogue::testing {

/// The numbers of a YAML sequence.
inline Vector vector_of(const YAML::Node& node) {
  Vector result(static_cast<Index>(node.size()));
  for (std::size_t i = 0; i < node.size(); ++i) result[static_cast<Index>(i)] = node[i].as<double>();
  return result;
}

}  // namespace hybrid_sphere::mechanics::catalogue::testing
