#pragma once

#include <string>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "scene/scene_number.hpp"
#include "scene/tree.hpp"

namespace hybrid_sphere {

/// A scene some of whose numbers are other ones in each run. The file is read once; a sample changes what was
/// read, and is checked as a scene in a file is.
class SceneVariation {
 public:
  /// @param scene      as a file gives it
  /// @param directory  to which names of images refer
  /// @param paths      of the numbers, see scene::SceneNumber
  /// @param where      put before a path in refusals
  /// @throws SceneError  if a path leads to no number, two of them to the same one, or a number cannot be
  /// given beside what the scene gives
  SceneVariation(scene::Tree scene, std::string directory, const std::vector<std::string>& paths,
                 const std::string& where);
  SceneVariation(const SceneVariation&) = delete;
  SceneVariation& operator=(const SceneVariation&) = delete;

  /// Takes a sample: a value for each path. @throws SceneError  if the scene refuses it
  void set(const double* sample);

  /// With the last sample; without one, as the file gives it.
  const scene::Scene& scene() const { return has_fields_ ? scene_ : read_; }

  /// Whether nothing but the initial state varies.
  bool varies_initial_state_alone() const { return varies_initial_state_alone_; }

  /// In the order of the paths.
  const std::vector<scene::SceneNumber>& numbers() const { return numbers_; }

  /// The scene as a file would give it.
  scene::Tree tree_of(const double* sample) const;

 private:
  bool is_within_ranges(const double* sample) const;
  void find_numbers(const std::vector<std::string>& paths, const std::string& where);
  void check_as_file() const;

  scene::Tree tree_;
  std::string directory_;
  scene::Scene scene_;  // to which numbers_ refer
  scene::Scene read_;   // anew for each run
  std::vector<scene::SceneNumber> numbers_;
  double body_factor_ = 0;  // gyration radius over radius of a solid or a shell; 0: it is given
  bool has_fields_ = true;  // that all numbers belong to: otherwise the tree is read for each run
  bool varies_initial_state_alone_ = true;
};

}  // namespace hybrid_sphere
