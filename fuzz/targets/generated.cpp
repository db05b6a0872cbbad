// Scenes of every character, made of the bytes, keep every invariant.

#include "draw_bytes.hpp"
#include "support/random_scenes.hpp"
#include "target.hpp"
#include "verdict.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace hybrid_sphere;
  fuzz::draw_from(data, size);
  const auto& characters = fuzz::characters();
  const auto kind = static_cast<std::size_t>(testing::integer(0, static_cast<int>(characters.size()) - 1));
  fuzz::Case a_case = fuzz::make_case(characters[kind]);
  a_case.duration /= 8;
  a_case.patient = false;  // the limits of time are for the release build
  const fuzz::Verdict verdict = fuzz::judge_invariants(a_case);
  if (verdict.kind == fuzz::Verdict::Kind::found)
    fuzz::found(verdict.claim + ": " + verdict.words + "\n" + fuzz::text_of(a_case));
  return 0;
}
