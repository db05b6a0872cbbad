#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "study/study.hpp"

/// Study files whose keys are changed one at a time, and what is said to them.
namespace hybrid_sphere::testing {

using namespace study;

inline const std::string scene =
    "scene: {sphere: {mass: 1, radius: 0.5, body: solid}, surface: {base: {law: coulomb, friction: 0.3}, "
    "regions: "
    "[{name: mat, law: rough, circle: {center: [0, 0], radius: 1}}, {name: ice, law: smooth, half_plane: "
    "{point: "
    "[2, 0], normal: [1, 0]}}]}}\n";

/// The keys of a study, each of which may be replaced or left out.
class Keys {
 public:
  Keys& set(const std::string& key, const std::string& value) {
    for (auto& [name, present] : keys_) {
      if (name == key) return present = value, *this;
    }
    keys_.emplace_back(key, value);
    return *this;
  }
  /// An empty value leaves the key out.
  std::string yaml() const {
    std::string text = scene;
    for (const auto& [key, value] : keys_) {
      if (!value.empty()) text += key + ": " + value + "\n";
    }
    return text;
  }

 private:
  std::vector<std::pair<std::string, std::string>> keys_ = {{"runs", "12"},
                                                            {"duration", "2"},
                                                            {"vary", "{sphere.mass: {uniform: [1, 2]}}"},
                                                            {"keep", "{end: [position]}"}};
};

inline std::string refusal_of(const std::string& yaml) {
  try {
    read_study_text(yaml);
  } catch (const scene::SceneError& error) {
    return error.what();
  }
  return "accepted";
}

inline void expect_refused(const Keys& keys, const std::string& message) {
  EXPECT_EQ(refusal_of(keys.yaml()), message);
}

inline void expect_refused(const std::string& key, const std::string& value, const std::string& message) {
  expect_refused(Keys().set(key, value), message);
}

inline const std::string is_refused = " is refused; allowed: ";

}  // namespace hybrid_sphere::testing
