// The results of all runs are those that the journal has, in whatever order the chunks came.

#include "study/results.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "study/experiment.hpp"
#include "support/temporary_file.hpp"

namespace hybrid_sphere::testing::results_test {
namespace {

using namespace study;

const char* const yaml = R"(
scene:
  sphere: {mass: 2, radius: 0.25, body: solid}
  initial_state: {position: [-1, 0.1], velocity: [1.5, 0.1]}
  surface:
    base: {law: coulomb, friction: 0.3}
    regions: [{name: ice, law: smooth, half_plane: {point: [0.5, 0], normal: [1, 0]}}]
runs: 53
chunk: 10
duration: 1
vary:
  initial_state.velocity[0]: {normal: {mean: 1.5, deviation: 0.5}}
  surface.base.friction: {uniform: [-0.1, 0.5]}
keep: {end: [position, mode, region], at: {times: [0, 0.5, 1], fields: [velocity, region]}, entered: [ice]}
)";

class StudyResults : public ::testing::Test {
 protected:
  StudyResults() : whole_(experiment_.columns().all) {
    const std::function<bool()> go_on = [] { return false; };
    Chunk chunk(columns().all);
    std::vector<unsigned char> bytes;
    for (const std::uint64_t number : {5U, 0U, 3U, 1U, 4U, 2U}) {
      experiment_.run(number * 10, std::min<std::uint64_t>(10, 53 - number * 10), chunk, go_on);
      chunk.encode(bytes);
      journal_.append(number, bytes);
    }
    experiment_.run(0, 53, whole_, go_on);
  }

  const Columns& columns() const { return experiment_.columns(); }
  double number(std::size_t column, std::uint64_t run, std::size_t element) {
    if (columns().all[column].type == Column::Type::real) return whole_.reals(column, run)[element];
    const std::int32_t code = whole_.codes(column, run)[element];
    return code < 0 ? std::nan("") : code;
  }

  void expect_numbers(const Results& results, std::size_t column, std::size_t element) {
    std::uint64_t run = 0;
    results.blocks(column, element)([&](const double* values, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i, ++run) {
        const double expected = number(column, run, element);
        EXPECT_TRUE(values[i] == expected || (std::isnan(values[i]) && std::isnan(expected)))
            << columns().all[column].name << " of run " << run << ": " << values[i] << ", not " << expected;
      }
    });
    EXPECT_EQ(run, 53U);
  }

  const Study study_ = read_study_text(yaml);
  Experiment experiment_{study_};
  Chunk whole_;
  const TemporaryFile file_{"results"};
  Journal journal_ = Journal::create(file_.path(), "identity");
};

TEST_F(StudyResults, HaveAsManyRunsAsTheStudy) {
  const Results results(study_, columns(), journal_);
  ASSERT_EQ(results.chunks(), 6U);
  EXPECT_EQ(results.runs_of(0), 10U);
  EXPECT_EQ(results.runs_of(5), 3U);
  EXPECT_EQ(results.first_run(5), 50U);
}

TEST_F(StudyResults, AreTheNumbersOfTheRunsInOrder) {
  const Results results(study_, columns(), journal_);
  for (const bool backwards : {false, true}) {
    for (std::size_t column = 0; column < columns().all.size(); ++column) {
      const std::size_t size = columns().all[column].size();
      for (std::size_t i = 0; i < size; ++i) expect_numbers(results, column, backwards ? size - 1 - i : i);
    }
  }
}

TEST_F(StudyResults, HaveTheRefusalsInTheOrderOfTheRuns) {
  const Results results(study_, columns(), journal_);
  ASSERT_EQ(results.refusals().size(), whole_.refusals.size());
  EXPECT_GT(results.refusals().size(), 0U);
  for (std::size_t i = 0; i < results.refusals().size(); ++i) {
    EXPECT_EQ(results.refusals()[i].run, whole_.refusals[i].run);
    EXPECT_EQ(results.refusals()[i].value, whole_.refusals[i].value);
  }
}

TEST_F(StudyResults, CountCodesAndWhatIsMissing) {
  const Results results(study_, columns(), journal_);
  const std::uint64_t refused = whole_.refusals.size();
  EXPECT_EQ(results.counts_of_codes(columns().outcome, 3),
            (std::vector<std::uint64_t>{53 - refused, 0, refused, 0}));
  const std::vector<std::uint64_t> regions = results.counts_of_codes(columns().end + 2, 2);
  EXPECT_EQ(regions[2], refused);
  EXPECT_EQ(regions[0] + regions[1], 53 - refused);
  EXPECT_GT(regions[1], 0U);
}

TEST_F(StudyResults, CannotBeReadFromAJournalOfOtherColumns) {
  const TemporaryFile file("other");
  Journal journal = Journal::create(file.path(), "identity");
  for (std::uint64_t chunk = 0; chunk < 6; ++chunk) journal.append(chunk, {0, 1, 2});
  EXPECT_THROW(Results(study_, columns(), journal), std::runtime_error);
}

}  // namespace
}  // namespace hybrid_sphere::testing::results_test
