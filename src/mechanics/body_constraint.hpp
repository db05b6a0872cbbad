#pragma once

#include <array>
#include <string>

#include "hybrid_sphere/mechanics/constraint.hpp"
#include "mechanics/body_motion.hpp"

namespace hybrid_sphere::mechanics {

/// The rows of a constraint on two bodies, with the twelve velocities v1, w1, v2, w2.
struct BodyRows {
  static constexpr int most = 6;
  template <int columns>
  using Matrix =
      Eigen::Matrix<double, Eigen::Dynamic, columns, columns == 1 ? 0 : Eigen::RowMajor, most, columns>;

  explicit BodyRows(Index rows)
      : value(Matrix<1>::Zero(rows)), gradient(Matrix<12>::Zero(rows, 12)), gamma(Matrix<1>::Zero(rows)) {}

  Matrix<1> value;      ///< f: of positions, dg/dq times the rate of q
  Matrix<12> gradient;  ///< df/d(v1, w1, v2, w2)
  Matrix<1> gamma;      ///< -df/dq times the rate of q
};

/// Constraints, linear in the velocities, of two bodies, of which one or the first alone may be the world.
class BodyConstraint : public ConstraintFunction {
 public:
  /// @param label  what NotFinite reports: "constraint rear hub"
  BodyConstraint(std::string label, Index first, Index second, Index size)
      : label_(std::move(label)), bodies_{first, second}, size_(size) {}

  Index size() const override { return size_; }
  bool depends_on(Index s) const override {
    const Index body = s / body_velocities;
    return body == bodies_[0] || body == bodies_[1];
  }
  void evaluate(double t, const Vector& q, const Vector& v, const Vector& rate,
                ConstraintTerms& terms) const override;
  void evaluate(double t, const Vector& q, const Vector& v, Vector& value, Matrix& gradient) const override;
  void add_curvature(double, const Vector&, const Vector&, const Vector&, Matrix&) const override {}

 protected:
  using Bodies = std::array<BodyMotion, 2>;
  virtual void fill(const Bodies& bodies, BodyRows& rows) const = 0;

  Bodies places(const Vector& q) const {
    return {BodyMotion::at(bodies_[0], q), BodyMotion::at(bodies_[1], q)};
  }
  void require_finite(const Vector& value) const;

 private:
  Bodies motions(const Vector& q, const Vector& v) const {
    return {BodyMotion::at(bodies_[0], q, v), BodyMotion::at(bodies_[1], q, v)};
  }
  /// Into all columns of the system.
  void spread(const BodyRows& rows, Index columns, Matrix& gradient) const;

  std::string label_;
  std::array<Index, 2> bodies_;
  Index size_;
};

}  // namespace hybrid_sphere::mechanics
