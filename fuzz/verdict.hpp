#pragma once

#include <functional>
#include <string>

#include "characters.hpp"

namespace hybrid_sphere::fuzz {

/// What became of a generated scene.
struct Verdict {
  enum class Kind : char {
    held = 'h',     ///< all that was looked at holds
    halted = 'a',   ///< the same, and the computation halted with a reason
    refused = 'r',  ///< the scene's reader refuses it
    skipped = 's',  ///< it says nothing: no answer is expected, or none of that accuracy
    found = 'f',    ///< a claim does not hold
  };
  Kind kind = Kind::held;
  std::string claim;  ///< that does not hold; the reason of a halt, of a refusal or of skipping it
  std::string words;  ///< where and by how much; of one line
};

using Judge = std::function<Verdict(const Case&)>;

/// The scene as the reader takes it from the text of a scene file.
/// @throws scene::SceneError
scene::Scene read_back(const scene::Scene& scene);

/// The text of a scene file, with the duration of the run in a comment.
std::string text_of(const Case& a_case);

/// Without numbers: two halts for one reason have the same.
std::string reason_alone(const std::string& words);

/// Everything that a run tells is finite, consistent with itself, with the map and with the laws of its
/// grounds, and the same to the bit with one output and with two hundred.
Verdict judge_invariants(const Case& a_case);

}  // namespace hybrid_sphere::fuzz
