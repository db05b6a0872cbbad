// The terms of joints against their formulas, differentiated automatically.
#include <gtest/gtest.h>

#include "core/mechanics/expect_parts.hpp"

namespace hybrid_sphere::mechanics::multibody_parts_test {
namespace {

using namespace testing;

template <class T>
Vector3<T> apart(const VectorX<T>& q) {
  return Place<T>(q, 1).point(point_on(second_placement, P)) -
         Place<T>(q, 0).point(point_on(first_placement, P));
}
/// Cosine of the angle between directions of either body.
template <class T>
T cosine(const VectorX<T>& q, const Vector3d& first, const Vector3d& second) {
  return Place<T>(q, 0)
      .direction(direction_on(first_placement, first))
      .dot(Place<T>(q, 1).direction(direction_on(second_placement, second)));
}

// Two unit vectors that make a right-handed frame with D.
const Vector3d B = D.unitOrthogonal();
const Vector3d C = D.cross(B);

TEST(MultibodyParts, BallIsTheRateOfADifference) {
  MultibodySystem system = two_bodies();
  system.ball("joint", "one", "two", P);
  expect_rate_of(system, [](const auto& q) {
    using T = std::decay_t<decltype(q[0])>;
    return VectorX<T>(apart<T>(q));
  });
}

TEST(MultibodyParts, HingeKeepsAPointAndAnAxis) {
  MultibodySystem system = two_bodies();
  system.hinge("joint", "one", "two", P, 3 * D);
  expect_rate_of(system, [](const auto& q) {
    using T = std::decay_t<decltype(q[0])>;
    VectorX<T> g(5);
    g << apart<T>(q), cosine<T>(q, D, C), cosine<T>(q, D, -B);
    return g;
  });
}

TEST(MultibodyParts, WeldKeepsAPointAndThreeAngles) {
  MultibodySystem system = two_bodies();
  system.weld("joint", "one", "two", P);
  expect_rate_of(system, [](const auto& q) {
    using T = std::decay_t<decltype(q[0])>;
    const Eigen::Matrix3d axes = first_placement.linear();
    VectorX<T> g(6);
    g << apart<T>(q), cosine<T>(q, axes.col(2), axes.col(1)), cosine<T>(q, axes.col(0), axes.col(2)),
        cosine<T>(q, axes.col(1), axes.col(0));
    return g;
  });
}

TEST(MultibodyParts, SliderKeepsTwoDistancesAndThreeAngles) {
  MultibodySystem system = two_bodies();
  system.slider("joint", "one", "two", P, D);
  expect_rate_of(system, [](const auto& q) {
    using T = std::decay_t<decltype(q[0])>;
    const Eigen::Matrix3d axes = first_placement.linear();
    const Place<T> one(q, 0);
    VectorX<T> g(5);
    g << one.direction(direction_on(first_placement, B)).dot(apart<T>(q)),
        one.direction(direction_on(first_placement, C)).dot(apart<T>(q)),
        cosine<T>(q, axes.col(2), axes.col(1)), cosine<T>(q, axes.col(0), axes.col(2)),
        cosine<T>(q, axes.col(1), axes.col(0));
    return g;
  });
}

TEST(MultibodyParts, LimitsAreTheRatesOfAnAngleAndOfADisplacement) {
  MultibodySystem hinge = two_bodies(), slider = two_bodies();
  hinge.hinge("joint", "one", "two", P, D).limit("joint", -1, 2);
  expect_rate_of(hinge, [](const auto& q) {
    using T = std::decay_t<decltype(q[0])>;
    return VectorX<T>(Eigen::Matrix<T, 1, 1>(2 - atan2(cosine<T>(q, C, B), cosine<T>(q, B, B))));
  });
  slider.slider("joint", "one", "two", P, D).limit("joint", -1, 2);
  expect_rate_of(slider, [](const auto& q) {
    using T = std::decay_t<decltype(q[0])>;
    const Vector3<T> along = Place<T>(q, 0).direction(direction_on(first_placement, D));
    return VectorX<T>(Eigen::Matrix<T, 1, 1>(2 - along.dot(apart<T>(q))));
  });
}

TEST(MultibodyParts, PlanarKeepsADistanceAndTwoAngles) {
  MultibodySystem system = two_bodies();
  system.planar("joint", "one", "two", P, D);
  expect_rate_of(system, [](const auto& q) {
    using T = std::decay_t<decltype(q[0])>;
    VectorX<T> g(3);
    g << Place<T>(q, 0).direction(direction_on(first_placement, D)).dot(apart<T>(q)), cosine<T>(q, D, C),
        cosine<T>(q, D, -B);
    return g;
  });
}

TEST(MultibodyParts, RodKeepsADistance) {
  MultibodySystem system = two_bodies();
  const Vector3d other = P + Vector3d(0.3, -0.1, 0.4);
  system.rod("joint", "one", "two", P, other);
  expect_rate_of(system, [&](const auto& q) {
    using T = std::decay_t<decltype(q[0])>;
    using std::sqrt;
    const Vector3<T> way = Place<T>(q, 1).point(point_on(second_placement, other)) -
                           Place<T>(q, 0).point(point_on(first_placement, P));
    return VectorX<T>(VectorX<T>::Constant(1, sqrt(way.squaredNorm()) - (other - P).norm()));
  });
}

// Of the world, a direction is fixed, and its point too.
TEST(MultibodyParts, JointsWithTheWorldAreThoseOfOneBody) {
  MultibodySystem system = two_bodies();
  system.hinge("joint", "world", "two", P, D);
  expect_rate_of(system, [](const auto& q) {
    using T = std::decay_t<decltype(q[0])>;
    const Place<T> two(q, 1);
    VectorX<T> g(5);
    g << two.point(point_on(second_placement, P)) - P.cast<T>(),
        two.direction(direction_on(second_placement, C)).dot(D.cast<T>()),
        -two.direction(direction_on(second_placement, B)).dot(D.cast<T>());
    return g;
  });
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::multibody_parts_test
