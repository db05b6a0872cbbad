#pragma once

#include <gtest/gtest.h>

#include <cstdint>

#include "interrupt/interrupt.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing {

/// While one lives, interruption points ask in every so many turns.
class QuestionsEvery {
 public:
  explicit QuestionsEvery(std::uint32_t turns) : before_(detail::turns_between_questions) {
    detail::turns_between_questions = turns;
  }
  ~QuestionsEvery() { detail::turns_between_questions = before_; }
  QuestionsEvery(const QuestionsEvery&) = delete;
  QuestionsEvery& operator=(const QuestionsEvery&) = delete;

 private:
  std::uint32_t before_;
};

/// Advances a simulation.
/// @return  how many interruption points it has passed
/// @throws Interrupted  after ten millions of them, instead of a hang
inline std::uint64_t count_turns(Simulation& simulation, double until,
                                 const Simulation::SwitchSink& on_switch = {}) {
  const QuestionsEvery questions(1);
  std::uint64_t turns = 0;
  simulation.set_interrupt([&] { return ++turns > 10'000'000; });
  simulation.advance_to(until, on_switch);
  simulation.set_interrupt({});
  return turns;
}

/// The same to the bit.
inline void expect_same(const RecordedState& a, const RecordedState& b) {
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.position, b.position) << "t = " << a.time;
  EXPECT_EQ(a.orientation.coeffs(), b.orientation.coeffs()) << "t = " << a.time;
  EXPECT_EQ(a.twist.velocity, b.twist.velocity) << "t = " << a.time;
  EXPECT_EQ(a.twist.angular_velocity, b.twist.angular_velocity) << "t = " << a.time;
  EXPECT_EQ(a.slip, b.slip) << "t = " << a.time;
  EXPECT_EQ(a.mode, b.mode) << "t = " << a.time;
  EXPECT_EQ(a.name, b.name) << "t = " << a.time;
}

/// As record(), by a simulation that is interrupted at random and gone on with.
/// @param turns  between two questions
/// @param one_in  so many questions are answered by "stop"
/// @param stops   out: how often it was interrupted
/// @param look    called wherever it was
template <class Look>
Record record_interrupted(const scene::Scene& scene, double until, int outputs, std::uint32_t turns,
                          std::uint32_t one_in, int& stops, const Look& look) {
  const QuestionsEvery questions(turns);
  Simulation simulation(scene);
  std::uint64_t random = 1;
  simulation.set_interrupt([&] {
    random = random * 6364136223846793005 + 1442695040888963407;
    return (random >> 33) % one_in == 0;
  });
  Record result;
  stops = 0;
  try {
    for (int i = 0; i <= outputs; ++i) {
      for (;;) {
        try {
          simulation.advance_to(until * i / outputs, recorder(result.switches));
          break;
        } catch (const Interrupted&) {
          ++stops;
          look(simulation);
        }
      }
      result.states.emplace_back(simulation);
    }
  } catch (const HaltedError& error) {
    result.halt = error.what();
    result.states.emplace_back(simulation);
  }
  return result;
}

}  // namespace hybrid_sphere::testing
