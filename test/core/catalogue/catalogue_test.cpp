// What every entry of the catalogue owes its reader, and what is refused.

#include "catalogue/catalogue.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "catalogue/entry_helpers.hpp"

namespace hybrid_sphere::mechanics::catalogue::catalogue_test {
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

struct Refused {
  friend std::ostream& operator<<(std::ostream& out, const Refused& refused) { return out << refused.name; }
  const char* name;
  const char* entry;
  std::vector<std::pair<const char*, double>> numbers;
  const char* said;
};

class CatalogueRefusal : public ::testing::TestWithParam<Refused> {};

TEST_P(CatalogueRefusal, ByNameValueAndWhatIsAllowed) {
  const Entry& one = entry(GetParam().entry);
  EXPECT_EQ(refusal([&] {
              Values values(one.parameters);
              for (const auto& [name, value] : GetParam().numbers) values.set(name, value);
              one.build(values);
            }),
            GetParam().said);
}

INSTANTIATE_TEST_SUITE_P(
    EveryBound, CatalogueRefusal,
    ::testing::Values(
        Refused{"Range", "rolling_disk", {{"m", 0}}, "m = 0 is refused; allowed: 1e-09 to 1e+09"},
        Refused{"RangeOfAnAngle",
                "paper_sphere",
                {{"theta", 3.25}},
                "theta = 3.25 is refused; allowed: 0 to 3.141592653589793"},
        Refused{"GyrationRadiusOfThePaperSphere",
                "paper_sphere",
                {{"R", 1e-9}, {"k", 1e-9}},
                "k = 1e-09 is refused; allowed: > 0, at most R sqrt(2/3) = 8.164965809277261e-10"},
        Refused{"GyrationRadiusInQuasiVelocities",
                "paper_sphere_quasi",
                {{"k", 2}},
                "k = 2 is refused; allowed: > 0, at most R sqrt(2/3) = 0.2041241452319315"},
        Refused{"GyrationRadiusOnTheTurntable",
                "turntable_ball",
                {{"k", 2}},
                "k = 2 is refused; allowed: > 0, at most R sqrt(2/3) = 0.408248290463863"},
        Refused{"LargestMoment",
                "chaplygin_ball",
                {{"A", 1e-9}, {"B", 0.75}, {"C", 0.25}},
                "B = 0.75 is refused; allowed: at most the sum of the other two moments of inertia, "
                "0.250000001"},
        Refused{"SumOfMoments",
                "chaplygin_ball",
                {{"A", 1}, {"B", 1}, {"C", 1}},
                "A + B + C = 3 is refused; allowed: at most 2 m R^2 = 0.75"},
        Refused{"NoOrientation",
                "chaplygin_ball",
                {{"qw", 0}, {"qy", 0}},
                "the length of qw, qx, qy, qz = 0 is refused; allowed: at least 1e-09"},
        Refused{"NoOrientationOfThePaperSphere",
                "paper_sphere_quasi",
                {{"qw", 5e-10}},
                "the length of qw, qx, qy, qz = 5e-10 is refused; allowed: at least 1e-09"},
        Refused{"WheelsHeavierThanAll",
                "chaplygin_carriage",
                {{"m", 4}, {"r", 0.5}, {"I_w", 1}},
                "I_w = 1 is refused; allowed: at most m r^2/2 = 0.5"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(Refusal, TellsANumberFromItsBound) {
  EXPECT_EQ(refusal([] { refuse("k", std::nextafter(0.25, 1), "at most " + shortest(0.25)); }),
            "k = 0.25000000000000006 is refused; allowed: at most 0.25");
  EXPECT_EQ(refusal([] { refuse("k", 1e-9, "0"); }), "k = 1e-09 is refused; allowed: 0");
}

// The exponential of gamma t overflows.
TEST(Known, IsEmptyWhereItsFormulaIsNotFinite) {
  Values values(entry("explicit_time").parameters);
  values.set("gamma", 1e3);
  const Example example = entry("explicit_time").build(values);
  EXPECT_TRUE(example.known(0.25));
  EXPECT_FALSE(example.known(6));
}

class CatalogueEntry : public ::testing::TestWithParam<std::string> {
 protected:
  const Entry& entry_ = entry(GetParam());
};

TEST_P(CatalogueEntry, ExplainsItself) {
  EXPECT_FALSE(entry_.title.empty());
  for (const char* part : {"coordinates", "\nL ", "\nQ ", "constraint", "Watch", "known", "source"}) {
    EXPECT_NE(entry_.description.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(entry_.description.back(), '\n');
  for (const char c : entry_.description) EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~')) << int{c};
}

TEST_P(CatalogueEntry, AllowsItsOwnNumbersAndSaysTheirUnits) {
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

TEST_P(CatalogueEntry, BuildsModelsThatAreModelsAndAlike) {
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
  if (example.known) {
    EXPECT_EQ(example.known(0)->q, example.initial.q);
  }
}

INSTANTIATE_TEST_SUITE_P(AllEntries, CatalogueEntry, ::testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const Entry& one : entries()) names.push_back(one.name);
                           return names;
                         }()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace hybrid_sphere::mechanics::catalogue::catalogue_test
