// The terms of joints and contacts against their formulas, differentiated automatically.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "core/mechanics/expect_terms.hpp"
#include "hybrid_sphere/mechanics/automatic.hpp"
#include "hybrid_sphere/mechanics/multibody_system.hpp"

namespace hybrid_sphere::mechanics::multibody_parts_test {
namespace {

using Eigen::Vector3d;

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using VectorX = Eigen::Matrix<T, Eigen::Dynamic, 1>;

/// A body's place and attitude among q, by Eigen's own quaternion.
template <class T>
struct Place {
  Place(const VectorX<T>& q, Index body)
      : x(q.template segment<3>(7 * body)),
        turn(Eigen::Quaternion<T>(q[7 * body + 3], q[7 * body + 4], q[7 * body + 5], q[7 * body + 6])
                 .normalized()) {}
  Vector3<T> direction(const Vector3d& d) const { return turn.toRotationMatrix() * d.cast<T>(); }
  Vector3<T> point(const Vector3d& r) const { return x + direction(r); }

  Vector3<T> x;
  Eigen::Quaternion<T> turn;
};

// Points and directions in the world, with the bodies at their placements.
const Vector3d P(0.3, -0.2, 0.7);
const Vector3d D = Vector3d(0.2, 0.5, -0.8).normalized();
const Vector3d normal = Vector3d(0.1, -0.3, 1).normalized();
const Vector3d origin(0.1, 0.4, -0.2);
const Plane plane{origin, 2.5 * normal};

Eigen::Isometry3d placement(double angle, const Vector3d& axis, const Vector3d& center) {
  return Eigen::Translation3d(center) * Eigen::AngleAxisd(angle, axis.normalized());
}
const Eigen::Isometry3d first_placement = placement(0.7, {1, 2, -1}, {0.5, 0.1, 0.4});
const Eigen::Isometry3d second_placement = placement(-1.1, {0, 1, 3}, {-0.3, 0.6, 1.4});

Vector3d point_on(const Eigen::Isometry3d& body, const Vector3d& p) { return body.inverse() * p; }
Vector3d direction_on(const Eigen::Isometry3d& body, const Vector3d& d) {
  return body.linear().transpose() * d;
}

MultibodySystem two_bodies() {
  MultibodySystem system;
  system.body("one", 2, Inertia(0.4, 0.5, 0.6, 0.05, -0.02, 0.03), first_placement)
      .body("two", 3, Inertia(1.1, 0.7, 0.9, 0.1, 0.04, -0.07), second_placement);
  return system;
}

/// The first derivative along x, and the second where T has one.
template <class T>
Eigen::VectorXd slopes(const VectorX<T>& f) {
  Eigen::VectorXd result(f.size());
  for (Index i = 0; i < f.size(); ++i) result[i] = plain(f[i].derivatives[0]);
  return result;
}

constexpr double rounding = 1e-13;  // of some hundred operations on numbers of order one to ten

/// Random places, with quaternions of any length, and velocities.
struct Random {
  RandomVectors random;
  Vector q() { return random(14) / 2 + Vector::Constant(14, 1.3); }
  Vector v() { return random(12); }
};

/// Terms for functions g(q) that vanish: f = dg/dq q', gamma = -(the second derivative at constant v).
template <class Positions>
void expect_rate_of(const MultibodySystem& system, Positions g) {
  const ConstraintFunction& function = *system.constraints.back().function;
  EXPECT_TRUE(function.has_position());
  Random random;
  for (int i = 0; i < 20; ++i) {
    const Vector q = random.q();
    const Vector v = random.v();
    Matrix directions;
    Vector drift;
    system.equations->directions(q, v, directions, drift);
    using T = Dual<double, 1>;
    const auto moved = [&](const Eigen::VectorXd& rate) {
      VectorX<T> place = Eigen::VectorXd(q).cast<T>();
      for (Index j = 0; j < q.size(); ++j) place[j].derivatives[0] = rate[j];
      return slopes<T>(g(place));
    };
    using Second = Dual<Dual<double, 1>, 1>;
    const Eigen::VectorXd rate = directions * v;
    VectorX<Second> accelerated(q.size());
    for (Index j = 0; j < q.size(); ++j) {
      accelerated[j] = q[j];
      accelerated[j].value.derivatives[0] = rate[j];
      accelerated[j].derivatives[0] = rate[j];
      accelerated[j].derivatives[0].derivatives[0] = drift[j];
    }
    const VectorX<Second> second = g(accelerated);
    ConstraintTerms terms;
    function.evaluate(0.3, q, v, Vector(rate), terms);
    Vector position;
    function.position(0.3, q, position);
    ASSERT_EQ(terms.value.size(), second.size());
    EXPECT_LE((terms.value - moved(rate)).cwiseAbs().maxCoeff(), 10 * rounding);
    for (Index b = 0; b < second.size(); ++b) {
      EXPECT_NEAR(position[b], plain(second[b]), rounding);
      EXPECT_NEAR(terms.gamma[b], -second[b].derivatives[0].derivatives[0], 100 * rounding);
    }
    for (Index j = 0; j < v.size(); ++j) {
      EXPECT_LE((terms.gradient.col(j) - moved(directions.col(j))).cwiseAbs().maxCoeff(), 10 * rounding);
    }
    // The value of positions is linear in any rate of q: what tells how far off they are.
    const Vector any = random.random(14);
    ConstraintTerms other;
    function.evaluate(0.3, q, v, any, other);
    EXPECT_LE((other.value - moved(any)).cwiseAbs().maxCoeff(), 10 * rounding);
  }
}

/// Terms for functions f(q, v) that are linear in v.
template <class Velocities>
void expect_terms_of(const ConstraintFunction& function, const EquationsOfMotion& equations, Velocities f) {
  Random random;
  for (int i = 0; i < 20; ++i) {
    const Vector q = random.q();
    const Vector v = random.v();
    Vector rate;
    equations.rate(q, v, rate);
    using T = Dual<double, 1>;
    VectorX<T> place = Eigen::VectorXd(q).cast<T>();
    for (Index j = 0; j < q.size(); ++j) place[j].derivatives[0] = rate[j];
    const VectorX<T> expected = f(place, Eigen::VectorXd(v));
    ConstraintTerms terms;
    function.evaluate(0.3, q, v, rate, terms);
    ASSERT_EQ(terms.value.size(), expected.size());
    for (Index b = 0; b < expected.size(); ++b) {
      EXPECT_NEAR(terms.value[b], expected[b].value, 10 * rounding);
      EXPECT_NEAR(terms.gamma[b], -expected[b].derivatives[0], 100 * rounding);
    }
    for (Index j = 0; j < v.size(); ++j) {
      const VectorX<T> column = f(place, Eigen::VectorXd(Eigen::VectorXd::Unit(v.size(), j)));
      for (Index b = 0; b < expected.size(); ++b) {
        EXPECT_NEAR(terms.gradient(b, j), column[b].value, 10 * rounding);
      }
    }
    Vector value;
    Matrix gradient;
    function.evaluate(0.3, q, v, value, gradient);
    EXPECT_LE((value - terms.value).cwiseAbs().maxCoeff(), 10 * rounding);
    EXPECT_EQ(gradient, terms.gradient);
    Matrix curvature = Matrix::Zero(v.size(), v.size());
    function.add_curvature(0.3, q, v, Vector::Ones(value.size()), curvature);
    EXPECT_EQ(curvature, Matrix::Zero(v.size(), v.size()));
  }
}

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

constexpr double radius = 0.35;

/// Of a sphere or a disk of body 1, about P.
template <class T>
struct Touch {
  Touch(const VectorX<T>& q, const Eigen::VectorXd& v, bool is_disk) {
    using std::sqrt;
    const Place<T> body(q, 1);
    const Vector3<T> n(T(normal.x()), T(normal.y()), T(normal.z()));
    const Vector3<T> spin = body.turn.toRotationMatrix() * Vector3d(v.segment<3>(9)).cast<T>();
    const Vector3<T> arm = body.direction(point_on(second_placement, P));
    up = n;
    along = Vector3d(Vector3d::UnitX() - normal * normal.x()).normalized().cast<T>();
    if (is_disk) {
      const Vector3<T> axle = body.direction(direction_on(second_placement, D));
      const Vector3<T> heading = axle.cross(n);
      along = heading / sqrt(heading.squaredNorm());
      up = along.cross(axle);
    }
    velocity = Vector3d(v.segment<3>(6)).cast<T>() + spin.cross(Vector3<T>(arm - radius * up));
    gap = n.dot(Vector3<T>(body.x + arm - origin.cast<T>() - radius * up));
  }

  Vector3<T> velocity;
  Vector3<T> up;
  Vector3<T> along;
  T gap;
};

ContactShape shape_of(bool is_disk) {
  return is_disk ? ContactShape::disk(radius, 2 * D, P) : ContactShape::sphere(radius, P);
}

TEST(MultibodyParts, RollingHasNoVelocityAtTheContact) {
  for (const bool is_disk : {false, true}) {
    MultibodySystem system = two_bodies();
    system.rolling("contact", "two", shape_of(is_disk), always(), plane);
    const ConstraintFunction& function = *system.constraints[0].function;
    expect_terms_of(function, *system.equations, [is_disk](const auto& q, const Eigen::VectorXd& v) {
      using T = std::decay_t<decltype(q[0])>;
      return VectorX<T>(Touch<T>(q, v, is_disk).velocity);
    });
    Random random;
    const Vector q = random.q();
    Vector position;
    function.position(0, q, position);
    const double gap = Touch<double>(q, random.v(), is_disk).gap;
    EXPECT_LE((position - gap * normal).cwiseAbs().maxCoeff(), rounding);
  }
}

TEST(MultibodyParts, ContactIsTheRateOfItsGap) {
  for (const bool is_disk : {false, true}) {
    MultibodySystem system = two_bodies();
    system.contact("contact", "two", shape_of(is_disk), 0.5, plane);
    const auto gap = [is_disk](const auto& q) {
      using T = std::decay_t<decltype(q[0])>;
      const Eigen::VectorXd still = Eigen::VectorXd::Zero(12);
      return VectorX<T>(VectorX<T>::Constant(1, Touch<T>(q, still, is_disk).gap));
    };
    expect_rate_of(system, gap);
    const Guard& guard = *system.constraints[0].schedule.guard;
    Random random;
    const Vector q = random.q();
    const Vector rate = random.random(14);
    VectorX<Dual<double, 1>> moving = Eigen::VectorXd(q).cast<Dual<double, 1>>();
    for (Index j = 0; j < q.size(); ++j) moving[j].derivatives[0] = rate[j];
    EXPECT_NEAR(guard.value(0, q), -gap(moving)[0].value, rounding);
    EXPECT_NEAR(guard.rate(0, q, rate), -gap(moving)[0].derivatives[0], 10 * rounding);
  }
}

TEST(MultibodyParts, FrictionIsTheSlipInADirection) {
  for (const bool is_disk : {false, true}) {
    for (const Slip slip : {Slip::along, Slip::across}) {
      MultibodySystem system = two_bodies();
      system.contact("contact", "two", shape_of(is_disk), 0, plane).friction("grip", "contact", slip, 0.4);
      EXPECT_EQ(system.constraints[1].friction->contact, std::size_t(0));
      EXPECT_EQ(system.constraints[1].friction->coefficient, 0.4);
      expect_terms_of(*system.constraints[1].function, *system.equations,
                      [=](const auto& q, const Eigen::VectorXd& v) {
                        using T = std::decay_t<decltype(q[0])>;
                        const Touch<T> touch(q, v, is_disk);
                        const Vector3<T> across = normal.cast<T>().cross(touch.along);
                        const Vector3<T> direction = slip == Slip::along ? touch.along : across;
                        return VectorX<T>(VectorX<T>::Constant(1, direction.dot(touch.velocity)));
                      });
    }
  }
}

TEST(MultibodyParts, BladeIsTheVelocityToItsLeft) {
  MultibodySystem system = two_bodies();
  system.blade("skate", "two", P, 4 * D, always(), plane);
  expect_terms_of(
      *system.constraints[0].function, *system.equations, [](const auto& q, const Eigen::VectorXd& v) {
        using T = std::decay_t<decltype(q[0])>;
        using std::sqrt;
        const Place<T> body(q, 1);
        const Vector3<T> left = normal.cast<T>().cross(body.direction(direction_on(second_placement, D)));
        const Vector3<T> spin = body.turn.toRotationMatrix() * Vector3d(v.segment<3>(9)).cast<T>();
        const Vector3<T> velocity =
            Vector3d(v.segment<3>(6)).cast<T>() + spin.cross(body.direction(point_on(second_placement, P)));
        return VectorX<T>(VectorX<T>::Constant(1, left.dot(velocity) / sqrt(left.squaredNorm())));
      });
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::multibody_parts_test
