#pragma once

#include <string>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "study/scene_number.hpp"
#include "study/study.hpp"

namespace hybrid_sphere::study {

/// The scene of a study with the numbers of a sample. The file is read once; a sample changes what was read,
/// and is checked as a scene in a file is.
class SceneVariation {
 public:
  /// @param study  has to live as long as this
  /// @throws SceneError  if a path leads to no number, two of them to the same one, or a number cannot be
  /// given beside what the scene gives
  explicit SceneVariation(const Study& study);
  SceneVariation(const SceneVariation&) = delete;
  SceneVariation& operator=(const SceneVariation&) = delete;

  /// Takes a sample. @throws SceneError  if the scene refuses it
  void set(const double* sample);

  /// With the last sample; without one, as the study gives it.
  const scene::Scene& scene() const { return has_fields_ ? scene_ : read_; }

  /// Whether nothing but the initial state varies.
  bool varies_initial_state_alone() const { return varies_initial_state_alone_; }

  /// The scene as a file would give it.
  scene::Tree tree_of(const double* sample) const;

  /// What is said before the runs: which variables leave the allowed range, and how often.
  /// @throws SceneError  if one of them is never within it
  std::vector<std::string> warnings() const;

 private:
  bool is_within_ranges(const double* sample) const;
  void find_numbers();
  void check_as_file() const;

  const Study* study_;
  scene::Scene scene_;  // to which numbers_ refer
  scene::Scene read_;   // anew for each run
  std::vector<SceneNumber> numbers_;
  double body_factor_ = 0;  // gyration radius over radius of a solid or a shell; 0: it is given
  bool has_fields_ = true;  // that all numbers belong to: otherwise the tree is read for each run
  bool varies_initial_state_alone_ = true;
};

}  // namespace hybrid_sphere::study
