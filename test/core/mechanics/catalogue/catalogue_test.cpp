// What every entry of the catalogue owes its reader, and what is refused.

#include "hybrid_sphere/mechanics/catalogue/catalogue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "hybrid_sphere/mechanics/catalogue/ingredients.hpp"

namespace hybrid_sphere::mechanics::catalogue {
namespace {

template <class Function>
std::string refusal(Function function) {
  try {
    function();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "nothing is refused";
}

TEST(Catalogue, HasEntriesOfDifferentNames) {
  std::set<std::string> names;
  for (const Entry& one : entries()) names.insert(one.name);
  EXPECT_EQ(names.size(), entries().size());
  EXPECT_EQ(names.size(), 13u);
}

TEST(Catalogue, TellsTheNamesThereAreWhereOneIsNot) {
  EXPECT_EQ(entry("rolling_disk").name, "rolling_disk");
  const std::string message = refusal([] { entry("rolling_disc"); });
  EXPECT_NE(message.find("\"rolling_disc\""), std::string::npos) << message;
  EXPECT_NE(message.find("chaplygin_sleigh, rolling_disk"), std::string::npos) << message;
}

TEST(Values, RefusesWhatIsNotAllowedByNameValueAndRange) {
  Values values({positive("m", 2, "mass [kg]"), not_negative("t_switch", 1, "[s]")});
  values.set("m", 3);
  EXPECT_EQ(values["m"], 3);
  EXPECT_EQ(values["t_switch"], 1);
  const std::string message = refusal([&] { values.set("m", -0.5); });
  for (const char* part : {"m = -0.5", "1e-09 to 1e+09"}) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
  EXPECT_NE(refusal([&] { values.set("m", std::numeric_limits<double>::quiet_NaN()); }).find("m = nan"),
            std::string::npos);
  EXPECT_NE(refusal([&] { values.set("t_switch", std::numeric_limits<double>::infinity()); }).find("inf"),
            std::string::npos);
  const std::string unknown = refusal([&] { values.set("M", 1); });
  EXPECT_NE(unknown.find("\"M\"; there are m, t_switch"), std::string::npos) << unknown;
  EXPECT_EQ(values["m"], 3) << "a refused value is not taken";
  EXPECT_THROW(values["M"], std::out_of_range);
}

class EntryOf : public ::testing::TestWithParam<std::string> {
 protected:
  const Entry& entry_ = entry(GetParam());
};

TEST_P(EntryOf, ExplainsItself) {
  EXPECT_FALSE(entry_.title.empty());
  for (const char* part : {"coordinates", "\nL ", "\nQ ", "constraint", "Watch", "known", "source"}) {
    EXPECT_NE(entry_.description.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(entry_.description.back(), '\n');
  for (const char c : entry_.description) EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~')) << int{c};
}

TEST_P(EntryOf, AllowsItsOwnNumbersAndSaysTheirUnits) {
  std::set<std::string> names;
  for (const Parameter& parameter : entry_.parameters) {
    names.insert(parameter.name);
    EXPECT_LE(parameter.low, parameter.value) << parameter.name;
    EXPECT_LE(parameter.value, parameter.high) << parameter.name;
    EXPECT_FALSE(parameter.meaning.empty()) << parameter.name;
  }
  EXPECT_EQ(names.size(), entry_.parameters.size());
  EXPECT_GT(entry_.duration, 0);
  EXPECT_GT(entry_.characteristic_time, 0);
}

TEST_P(EntryOf, BuildsModelsThatAreModelsAndAlike) {
  const Example example = entry_.build(Values(entry_.parameters));
  EXPECT_NO_THROW(check(example.model));
  EXPECT_NO_THROW(check(example.by_hand));
  EXPECT_EQ(example.model.coordinates, example.by_hand.coordinates);
  EXPECT_EQ(example.model.velocities, example.by_hand.velocities);
  ASSERT_EQ(example.model.constraints.size(), example.by_hand.constraints.size());
  for (std::size_t i = 0; i < example.model.constraints.size(); ++i) {
    const Schedule &one = example.model.constraints[i].schedule,
                   &other = example.by_hand.constraints[i].schedule;
    EXPECT_EQ(one.begin, other.begin);
    EXPECT_EQ(one.end, other.end);
    EXPECT_EQ(one.guard == nullptr, other.guard == nullptr);
  }
  EXPECT_EQ(example.initial.time, 0);
  EXPECT_EQ(static_cast<std::size_t>(example.initial.q.size()), example.model.coordinates.size());
  EXPECT_EQ(static_cast<std::size_t>(example.initial.v.size()), example.model.velocities.size());
  EXPECT_FALSE(static_cast<bool>(example.known) && example.known(0) &&
               example.known(0)->q != example.initial.q);
}

INSTANTIATE_TEST_SUITE_P(AllEntries, EntryOf, ::testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const Entry& one : entries()) names.push_back(one.name);
                           return names;
                         }()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace hybrid_sphere::mechanics::catalogue
