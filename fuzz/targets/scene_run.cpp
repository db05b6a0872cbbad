// A scene that is taken can be run for a while, and keeps every invariant.

#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "target.hpp"
#include "verdict.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace hybrid_sphere;
  fuzz::Case a_case;
  try {
    a_case.scene =
        scene::read_scene(scene::tree_from_yaml(std::string(reinterpret_cast<const char*>(data), size)));
  } catch (const scene::SceneError&) {
    return 0;
  }
  a_case.duration = 0.25;
  a_case.patient = false;  // the limits of time are for the release build
  const fuzz::Verdict verdict = fuzz::judge_invariants(a_case);
  if (verdict.kind == fuzz::Verdict::Kind::found)
    fuzz::found(verdict.claim + ": " + verdict.words + "\n" + fuzz::text_of(a_case));
  return 0;
}
