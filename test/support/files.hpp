#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace hybrid_sphere::testing {

/// Names without ".yaml" of the YAML files in a folder of test/data, in order; NAME.expected.yaml belong to
/// NAME.yaml.
inline std::vector<std::string> yaml_files(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(TEST_DATA_DIR) + "/" + folder)) {
    const std::filesystem::path stem = entry.path().stem();
    if (entry.path().extension() == ".yaml" && stem.extension() != ".expected")
      names.push_back(stem.string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// A file's name as a part of a test's name: letters, digits and underscores only.
inline std::string as_test_name(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

}  // namespace hybrid_sphere::testing
