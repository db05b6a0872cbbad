#include "mechanics/contact_reactions.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "interrupt/interrupt.hpp"
#include "mechanics/decompositions/least_norm.hpp"
#include "mechanics/linear_complementarity.hpp"

namespace hybrid_sphere::mechanics {
namespace {

using Cone = ContactEquations::Cone;

ContactReactions reactions_of(const ContactEquations& equations, const Vector& reactions,
                              const Vector& slips) {
  return {reactions, equations.effect * reactions + equations.free, slips};
}

/// Coulomb's law with a polyhedral cone, as a linear complementarity problem (Stewart and Trinkle). A
/// friction reacts along an axis and against it, and along the direction across, if it has two rows.
class Pyramids {
 public:
  explicit Pyramids(const ContactEquations& equations) : equations_(equations) {
    for (const Cone& cone : equations.cones) {
      Vector axis = -equations.free.segment(cone.first, cone.size);
      if (cone.size == 1 || !(axis.norm() > 0)) axis = Vector::Unit(cone.size, 0);
      axes_.emplace_back(axis.normalized());
    }
  }

  void turn_to(const Vector& reactions) {
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const Cone& cone = equations_.cones[i];
      const Vector axis = reactions.segment(cone.first, cone.size);
      if (cone.size > 1 && axis.norm() > 0) axes_[i] = axis.normalized();
    }
  }
  void turn_by(double angle) {
    for (Vector& axis : axes_) {
      if (axis.size() > 1) axis = Eigen::Rotation2Dd(angle) * Eigen::Vector2d(axis);
    }
  }

  /// Exact for frictions of one row.
  std::optional<ContactReactions> solve() const {
    const Index rows = equations_.free.size();
    const Index contacts = equations_.contacts;
    const auto cones = static_cast<Index>(axes_.size());
    const std::vector<Side> all = this->sides();
    const auto sides = static_cast<Index>(all.size());
    Matrix generators = Matrix::Zero(rows, contacts + sides);
    generators.topLeftCorner(contacts, contacts).setIdentity();
    Matrix A = Matrix::Zero(contacts + sides + cones, contacts + sides + cones);
    Vector right(A.rows());
    for (Index i = 0; i < sides; ++i) {
      const Side& side = all[std::size_t(i)];
      const Cone& cone = equations_.cones[std::size_t(side.cone)];
      generators.col(contacts + i).segment(cone.first, cone.size) = side.direction;
      A(contacts + i, contacts + sides + side.cone) = 1;
      A(contacts + sides + side.cone, contacts + i) = -1;
    }
    for (Index i = 0; i < cones; ++i) {
      const Cone& cone = equations_.cones[std::size_t(i)];
      if (cone.contact >= 0) A(contacts + sides + i, cone.contact) = cone.coefficient;
      right[contacts + sides + i] = cone.limit;
    }
    A.topLeftCorner(contacts + sides, contacts + sides) =
        generators.transpose() * equations_.effect * generators;
    right.head(contacts + sides) = generators.transpose() * equations_.free;
    const std::optional<Vector> z = solve_complementarity(A, right);
    if (!z) return std::nullopt;
    return reactions_of(equations_, generators * z->head(contacts + sides), z->tail(cones));
  }

 private:
  struct Side {
    Index cone;
    Vector direction;
  };
  std::vector<Side> sides() const {
    std::vector<Side> all;
    for (const double sign : {1.0, -1.0}) {
      for (std::size_t i = 0; i < axes_.size(); ++i) {
        const Vector& axis = axes_[i];
        all.push_back({Index(i), sign * axis});
        if (axis.size() == 2) all.push_back({Index(i), sign * Eigen::Vector2d(-axis[1], axis[0])});
      }
    }
    return all;
  }

  const ContactEquations& equations_;
  std::vector<Vector> axes_;
};

double limit_of(const Cone& cone, const Vector& reactions) {
  return cone.limit + (cone.contact >= 0 ? cone.coefficient * std::max(0.0, reactions[cone.contact]) : 0);
}

/// The residual of the law: lambda less the nearest point of its cone to lambda - a (Alart and Curnier),
/// and its derivative.
struct Residual {
  Vector value;
  Matrix jacobian;

  Residual(const ContactEquations& equations, const Vector& reactions) {
    const Matrix& W = equations.effect;
    const Vector trial = reactions - (W * reactions + equations.free);
    value = reactions;
    jacobian = Matrix::Identity(reactions.size(), reactions.size());
    for (Index i = 0; i < equations.contacts; ++i) {
      if (!(trial[i] > 0)) continue;
      value[i] -= trial[i];
      jacobian.row(i) = W.row(i);
    }
    for (const Cone& cone : equations.cones) {
      const double radius = limit_of(cone, reactions);
      const Vector at = trial.segment(cone.first, cone.size);
      const double length = at.norm();
      if (!(length > radius)) {  // sticks
        value.segment(cone.first, cone.size) -= at;
        jacobian.middleRows(cone.first, cone.size) = W.middleRows(cone.first, cone.size);
      } else if (radius > 0) {
        const Vector direction = at / length;
        const Matrix across =
            Matrix::Identity(cone.size, cone.size) - Matrix(direction * direction.transpose());
        Matrix change = Matrix::Zero(cone.size, reactions.size());
        change.middleCols(cone.first, cone.size).setIdentity();
        change -= W.middleRows(cone.first, cone.size);
        value.segment(cone.first, cone.size) -= radius * direction;
        jacobian.middleRows(cone.first, cone.size) -= radius / length * across * change;
        if (cone.contact >= 0 && reactions[cone.contact] > 0) {
          jacobian.block(cone.first, cone.contact, cone.size, 1) -= cone.coefficient * direction;
        }
      }
    }
  }
};

/// abs(a) of the frictions that slide, 0 of others.
Vector slips_of(const ContactEquations& equations, const Vector& reactions) {
  const Vector accelerations = equations.effect * reactions + equations.free;
  Vector slips = Vector::Zero(Index(equations.cones.size()));
  for (Index i = 0; i < slips.size(); ++i) {
    const Cone& cone = equations.cones[std::size_t(i)];
    const Vector a = accelerations.segment(cone.first, cone.size);
    const Vector trial = reactions.segment(cone.first, cone.size) - a;
    if (trial.norm() > limit_of(cone, reactions)) slips[i] = a.norm();
  }
  return slips;
}

/// Newton's method on the residual. @return  whether it converges
bool polish(const ContactEquations& equations, Vector& reactions) {
  constexpr int few = 20;
  constexpr double rounding = 4e-15;
  constexpr double noise = 1e-11;  // of redundant contacts: what does not get less any more
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < few; ++i) {
    const Residual residual(equations, reactions);
    const double size = residual.value.lpNorm<Eigen::Infinity>();
    const double scale = 1 + reactions.lpNorm<Eigen::Infinity>();
    if (!std::isfinite(size)) return false;
    if (size <= rounding * scale || (size <= noise * scale && !(size < 0.5 * before))) return true;
    before = size;
    reactions -= LeastNorm(residual.jacobian).solve(residual.value);
  }
  return false;
}

}  // namespace

// A pyramid touches its cone at its corners. Its axis is turned towards the reaction until one of them is
// where the reaction is; Newton's method takes the last part of the way.
std::optional<ContactReactions> solve_contacts(const ContactEquations& equations) {
  constexpr int most = 50;
  constexpr double quarter_turn = 1.5707963267948966;
  Pyramids pyramids(equations);
  const bool has_cones = std::any_of(equations.cones.begin(), equations.cones.end(),
                                     [](const Cone& cone) { return cone.size > 1; });
  for (int i = 0; i < most; ++i) {
    interruption_point();
    const std::optional<ContactReactions> found = pyramids.solve();
    if (!has_cones) return found;
    Vector reactions = found ? found->reactions : Vector(Vector::Zero(equations.free.size()));
    if (polish(equations, reactions)) {
      return reactions_of(equations, reactions, slips_of(equations, reactions));
    }
    if (found) {
      pyramids.turn_to(found->reactions - found->accelerations);
    } else {
      pyramids.turn_by(quarter_turn / most);
    }
  }
  return std::nullopt;
}

}  // namespace hybrid_sphere::mechanics
