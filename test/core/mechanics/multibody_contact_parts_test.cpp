// The terms of contacts against their formulas, differentiated automatically.
#include <gtest/gtest.h>

#include "core/mechanics/expect_parts.hpp"

namespace hybrid_sphere::mechanics::multibody_contact_parts_test {
namespace {

using namespace testing;

// In the world, with the bodies at their placements.
const Vector3d normal = Vector3d(0.1, -0.3, 1).normalized();
const Vector3d origin(0.1, 0.4, -0.2);
constexpr double radius = 0.35;
const Vector3d second_center = P - Vector3d(0.4, 0.5, 0.1);
constexpr double second_radius = 0.22;

/// A shape of body 1 about P, and where it touches.
struct Shape {
  bool is_disk;
  enum Surface { still_plane, plane_of_body, sphere } surface;  // the latter two of body 0

  ContactShape of_body() const {
    return is_disk ? ContactShape::disk(radius, 2 * D, P) : ContactShape::sphere(radius, P);
  }
  Plane plane() const { return {origin, 2.5 * normal, surface == plane_of_body ? "one" : "world"}; }
  void add_contact(MultibodySystem& system, double restitution) const {
    if (surface == sphere) {
      system.contact("contact", "two", of_body(), "one", ContactShape::sphere(second_radius, second_center),
                     restitution);
    } else {
      system.contact("contact", "two", of_body(), restitution, plane());
    }
  }
};

const Shape on_planes[] = {{false, Shape::still_plane},
                           {true, Shape::still_plane},
                           {false, Shape::plane_of_body},
                           {true, Shape::plane_of_body}};
const Shape on_all[] = {on_planes[0], on_planes[1], on_planes[2], on_planes[3], {false, Shape::sphere}};

/// The surface below a point.
template <class T>
struct Below {
  Below(const VectorX<T>& q, Shape::Surface surface, const Vector3<T>& center) {
    using std::sqrt;
    n = normal.cast<T>();
    point = origin.cast<T>();
    axis = Vector3d(Vector3d::UnitX()).cast<T>();
    if (surface == Shape::still_plane) return;
    const Place<T> body(q, 0);
    if (surface == Shape::plane_of_body) {
      n = body.direction(direction_on(first_placement, normal));
      point = body.point(point_on(first_placement, origin));
      axis = body.direction(direction_on(first_placement, Vector3d::UnitX()));
      return;
    }
    const Vector3<T> other = body.point(point_on(first_placement, second_center));
    const Vector3<T> way = center - other;
    n = way / sqrt(way.squaredNorm());
    point = other + n * T(second_radius);
    axis = Vector3d(Vector3d::UnitZ()).cast<T>();  // the nearest to the surface at the placements
  }

  Vector3<T> n;
  Vector3<T> point;
  Vector3<T> axis;
};

/// The velocity of the material of a body at a point in the world.
template <class T>
Vector3<T> material(const VectorX<T>& q, const Eigen::VectorXd& v, Index body, const Vector3<T>& point) {
  const Place<T> place(q, body);
  const Vector3<T> spin = place.turn.toRotationMatrix() * Vector3d(v.segment<3>(6 * body + 3)).cast<T>();
  return Vector3d(v.segment<3>(6 * body)).cast<T>() + spin.cross(Vector3<T>(point - place.x));
}

template <class T>
struct Touch {
  Touch(const VectorX<T>& q, const Eigen::VectorXd& v, const Shape& shape) {
    using std::sqrt;
    const Place<T> body(q, 1);
    const Vector3<T> center = body.point(point_on(second_placement, P));
    const Below<T> below(q, shape.surface, center);
    n = below.n;
    Vector3<T> up = n;
    const Vector3<T> level = below.axis - n * n.dot(below.axis);
    along = level / sqrt(level.squaredNorm());
    if (shape.is_disk) {
      const Vector3<T> axle = body.direction(direction_on(second_placement, D));
      const Vector3<T> heading = axle.cross(n);
      along = heading / sqrt(heading.squaredNorm());
      up = along.cross(axle);
    }
    const Vector3<T> foot = center - up * T(radius);
    velocity = material<T>(q, v, 1, foot);
    if (shape.surface != Shape::still_plane) velocity -= material<T>(q, v, 0, foot);
    gap = n.dot(Vector3<T>(foot - below.point));
  }

  Vector3<T> velocity;
  Vector3<T> n;
  Vector3<T> along;
  T gap;
};

TEST(MultibodyContactParts, RollingHasNoVelocityAtTheContact) {
  for (const Shape& shape : on_planes) {
    MultibodySystem system = two_bodies();
    system.rolling("contact", "two", shape.of_body(), always(), shape.plane());
    const ConstraintFunction& function = *system.constraints[0].function;
    expect_terms_of(function, *system.equations, [shape](const auto& q, const Eigen::VectorXd& v) {
      using T = std::decay_t<decltype(q[0])>;
      return VectorX<T>(Touch<T>(q, v, shape).velocity);
    });
    Random random;
    const Vector q = random.q();
    Vector position;
    function.position(0, q, position);
    const Touch<double> touch(q, random.v(), shape);
    EXPECT_LE((position - touch.gap * touch.n).cwiseAbs().maxCoeff(), rounding);
  }
}

TEST(MultibodyContactParts, ContactIsTheRateOfItsGap) {
  for (const Shape& shape : on_all) {
    MultibodySystem system = two_bodies();
    shape.add_contact(system, 0.5);
    const auto gap = [shape](const auto& q) {
      using T = std::decay_t<decltype(q[0])>;
      const Eigen::VectorXd still = Eigen::VectorXd::Zero(12);
      return VectorX<T>(VectorX<T>::Constant(1, Touch<T>(q, still, shape).gap));
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

TEST(MultibodyContactParts, FrictionIsTheSlipInADirection) {
  for (const Shape& shape : on_all) {
    for (const Slip slip : {Slip::along, Slip::across}) {
      MultibodySystem system = two_bodies();
      shape.add_contact(system, 0);
      system.friction("grip", "contact", slip, 0.4);
      EXPECT_EQ(system.constraints[1].friction->contact, std::size_t(0));
      EXPECT_EQ(system.constraints[1].friction->coefficient, 0.4);
      expect_terms_of(*system.constraints[1].function, *system.equations,
                      [=](const auto& q, const Eigen::VectorXd& v) {
                        using T = std::decay_t<decltype(q[0])>;
                        const Touch<T> touch(q, v, shape);
                        const Vector3<T> across = touch.n.cross(touch.along);
                        const Vector3<T> direction = slip == Slip::along ? touch.along : across;
                        return VectorX<T>(VectorX<T>::Constant(1, direction.dot(touch.velocity)));
                      });
    }
  }
}

TEST(MultibodyContactParts, BladeIsTheVelocityToItsLeft) {
  for (const Shape::Surface surface : {Shape::still_plane, Shape::plane_of_body}) {
    const Shape shape{false, surface};
    MultibodySystem system = two_bodies();
    system.blade("skate", "two", P, 4 * D, always(), shape.plane());
    expect_terms_of(
        *system.constraints[0].function, *system.equations, [=](const auto& q, const Eigen::VectorXd& v) {
          using T = std::decay_t<decltype(q[0])>;
          using std::sqrt;
          const Place<T> body(q, 1);
          const Vector3<T> foot = body.point(point_on(second_placement, P));
          const Vector3<T> heading = body.direction(direction_on(second_placement, D));
          const Vector3<T> left = Below<T>(q, surface, foot).n.cross(heading);
          Vector3<T> velocity = material<T>(q, v, 1, foot);
          if (surface == Shape::plane_of_body) velocity -= material<T>(q, v, 0, foot);
          return VectorX<T>(VectorX<T>::Constant(1, left.dot(velocity) / sqrt(left.squaredNorm())));
        });
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::multibody_contact_parts_test
