#include "hybrid_sphere/mechanics/model.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "hybrid_sphere/mechanics/by_hand.hpp"

namespace hybrid_sphere::testing::model_test {
namespace {

using namespace mechanics;

std::shared_ptr<const ConstraintFunction> function_of_size(Index size) {
  return constraint_by_hand(size,
                            [](double, const Vector&, const Vector&, const Vector&, ConstraintTerms&) {});
}

Model sound_model() {
  Model model;
  model.coordinates = {"x", "y"};
  model.velocities = {"x_dot", "y_dot"};
  model.equations = equations_by_hand(2, 2, [](double, const Vector&, const Vector&, MotionTerms&) {});
  model.constraints = {{"rolling", function_of_size(2), {}},
                       {"blade", function_of_size(1), {}},
                       {"chain", function_of_size(3), {}}};
  return model;
}

std::string refusal_of(const Model& model) {
  try {
    check(model);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Model, CountsTheMultipliersOfItsConstraintsInTheirOrder) {
  const Model model = sound_model();
  EXPECT_EQ(model.multipliers(), 6);
  EXPECT_EQ(model.multiplier_of(0), 0);
  EXPECT_EQ(model.multiplier_of(1), 2);
  EXPECT_EQ(model.multiplier_of(2), 3);
}

TEST(Model, FindsAConstraintAndItsMultipliersByName) {
  const Model model = sound_model();
  EXPECT_EQ(model.index_of_constraint("blade"), 1u);
  const Vector all = {1, 2, 3, 4, 5, 6};
  EXPECT_EQ(model.multipliers_of("rolling", all), (Vector{1, 2}));
  EXPECT_EQ(model.multipliers_of("blade", all), Vector{3});
  EXPECT_EQ(model.multipliers_of("chain", all), (Vector{4, 5, 6}));
}

TEST(Model, ListsConstraintsByTheirNames) {
  EXPECT_EQ(names(sound_model(), {0, 2}), "rolling, chain");
  EXPECT_EQ(names(sound_model(), {1}), "blade");
  EXPECT_EQ(names(sound_model(), {}), "");
}

TEST(Model, PassesTheCheckWhereItIsSound) {
  Model model = sound_model();
  EXPECT_EQ(refusal_of(model), "accepted");
  model.constraints[0].schedule = {1, 1, nullptr};
  EXPECT_EQ(refusal_of(model), "accepted");
  model.constraints.clear();
  EXPECT_EQ(refusal_of(model), "accepted");
}

TEST(Model, NeedsEquationsOfMotion) {
  Model model = sound_model();
  model.equations = nullptr;
  EXPECT_EQ(refusal_of(model), "model: it has no equations of motion");
  model.equations = equations_by_hand(0, 0, [](double, const Vector&, const Vector&, MotionTerms&) {});
  EXPECT_NE(refusal_of(model).find("0 coordinates and 0 velocities"), std::string::npos);
}

TEST(Model, NeedsANameForEachCoordinateAndVelocity) {
  Model model = sound_model();
  model.coordinates.push_back("z");
  EXPECT_EQ(refusal_of(model), "model: 3 names of coordinates, but its equations have 2");
  model = sound_model();
  model.velocities.pop_back();
  EXPECT_EQ(refusal_of(model), "model: 1 names of velocities, but its equations have 2");
}

TEST(Model, RefusesEmptyNamesAndNamesThatAreThereTwice) {
  Model model = sound_model();
  model.coordinates[1] = "";
  EXPECT_EQ(refusal_of(model), "model: a coordinate has an empty name");
  model = sound_model();
  model.velocities[1] = "x";
  EXPECT_EQ(refusal_of(model), "model: the name \"x\" of a velocity appears twice");
  model = sound_model();
  model.constraints[2].name = "rolling";
  EXPECT_EQ(refusal_of(model), "model: the name \"rolling\" of a constraint appears twice");
  model.constraints[2].name = "";
  EXPECT_EQ(refusal_of(model), "model: a constraint has an empty name");
}

TEST(Model, RefusesAConstraintWithoutFunctionOrSize) {
  Model model = sound_model();
  model.constraints[1].function = nullptr;
  EXPECT_EQ(refusal_of(model), "constraint blade: it has no function");
  model.constraints[1].function = function_of_size(0);
  EXPECT_EQ(refusal_of(model), "constraint blade: size() is 0; at least 1 is needed");
}

TEST(Model, RefusesAnIntervalThatEndsBeforeItBeginsOrIsNoInterval) {
  Model model = sound_model();
  model.constraints[1].schedule = {2.5, 1.25, nullptr};
  EXPECT_EQ(refusal_of(model), "constraint blade: its interval ends at 1.25 before it begins at 2.5");
  model.constraints[1].schedule = {std::numeric_limits<double>::quiet_NaN(), 1, nullptr};
  EXPECT_EQ(refusal_of(model), "constraint blade: its interval begins or ends at NaN");
}

}  // namespace
}  // namespace hybrid_sphere::testing::model_test
