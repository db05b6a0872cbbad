#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>
#include <vector>

/// The event loops of simulators that solve for all obstacles and take the smallest time, on discs that give
/// a sphere the velocity of rolling: what an event costs and decides without certificates. Written from the
/// descriptions that each names.
namespace hybrid_sphere::peers {

template <class Real>
using Vector = Eigen::Matrix<Real, 2, 1>;

/// A disc of rough ground that moves.
template <class Real>
struct Disc {
  Vector<Real> center;
  Real radius;
  Vector<Real> belt;
};

constexpr int none = -1;

/// Straight paths as event-driven billiards follow them: the collision with every obstacle, the first of
/// them, a relocation to the right side of its edge, its rule (DynamicalBilliards.jl, Internals; Datseris,
/// J. Open Source Softw. 2, 458, 2017). A disc is entered and left as by ray splitting: docs/theory.md 3.1
/// gives the velocity inside, v = p_c + kappa u.
template <class Real>
class BilliardLoop {
 public:
  BilliardLoop(std::vector<Disc<Real>> discs, const Real& kappa) : discs_(std::move(discs)), kappa_(kappa) {}

  void place(const Vector<Real>& position, const Vector<Real>& velocity,
             const Vector<Real>& contact_velocity) {
    position_ = position;
    velocity_ = velocity;
    conserved_ = velocity - kappa_ * contact_velocity;
    inside_ = none;
  }
  const Vector<Real>& position() const { return position_; }

  /// Passes the next event.
  /// @return its disc; `none` if there is none, and nothing has changed
  int pass() {
    Real first = std::numeric_limits<double>::max();
    int which = none;
    for (std::size_t i = 0; i < discs_.size(); ++i) {
      const Real time = collision(static_cast<int>(i));
      if (time < first) {
        first = time;
        which = static_cast<int>(i);
      }
    }
    if (which == none) return none;
    position_ += first * velocity_;
    relocate(discs_[static_cast<std::size_t>(which)], which != inside_);
    if (which == inside_) {
      inside_ = none;
    } else {
      inside_ = which;
      velocity_ = conserved_ + kappa_ * discs_[static_cast<std::size_t>(which)].belt;
    }
    return which;
  }

 private:
  Real collision(int i) const {
    using std::sqrt;
    const Disc<Real>& disc = discs_[static_cast<std::size_t>(i)];
    const Vector<Real> away = position_ - disc.center;
    const Real square = velocity_.squaredNorm();
    const Real b = away.dot(velocity_);
    const Real discriminant = b * b - square * (away.squaredNorm() - disc.radius * disc.radius);
    if (discriminant <= 0) return std::numeric_limits<double>::max();
    const Real root = sqrt(discriminant);
    const Real time = i == inside_ ? Real((root - b) / square) : Real((-root - b) / square);
    return time > 0 ? time : Real(std::numeric_limits<double>::max());
  }

  /// Beyond the edge, by the distance to it.
  void relocate(const Disc<Real>& disc, bool enters) {
    const Vector<Real> away = position_ - disc.center;
    const Real size = away.norm();
    const Real depth = disc.radius - size;
    if (enters ? depth < 0 : depth > 0) position_ += depth / size * away;
  }

  std::vector<Disc<Real>> discs_;
  Real kappa_;
  Vector<Real> position_ = Vector<Real>::Zero();
  Vector<Real> velocity_ = Vector<Real>::Zero();
  Vector<Real> conserved_ = Vector<Real>::Zero();
  int inside_ = none;
};

/// Parabolas as simulators of pool follow them: the roots of a quartic for every disc, as eigenvalues of its
/// companion matrix, and of those that are real the smallest after now (pooltool; W. Leckie and M. Greenspan,
/// An event-based pool physics simulator, LNCS 4250, Springer 2006).
class PoolLoop {
 public:
  explicit PoolLoop(std::vector<Disc<double>> discs) : discs_(std::move(discs)) {}

  /// Time to the edge of a disc that is met first; infinite if none is.
  double first_contact(const Eigen::Vector2d& position, const Eigen::Vector2d& velocity,
                       const Eigen::Vector2d& acceleration) const {
    double first = std::numeric_limits<double>::infinity();
    for (const Disc<double>& disc : discs_) {
      const Eigen::Vector2d away = position - disc.center;
      first = std::min(first,
                       smallest_root({0.25 * acceleration.squaredNorm(), acceleration.dot(velocity),
                                      velocity.squaredNorm() + acceleration.dot(away), 2 * velocity.dot(away),
                                      away.squaredNorm() - disc.radius * disc.radius}));
    }
    return first;
  }

 private:
  /// @param c  from t^4 down to 1
  static double smallest_root(const std::array<double, 5>& c) {
    constexpr double real = 1e-9;    // of a root, against its imaginary part
    constexpr double later = 1e-12;  // [s]
    Eigen::Matrix4d companion = Eigen::Matrix4d::Zero();
    for (Eigen::Index i = 0; i < 4; ++i) companion(0, i) = -c[static_cast<std::size_t>(i) + 1] / c[0];
    for (Eigen::Index i = 1; i < 4; ++i) companion(i, i - 1) = 1;
    const Eigen::EigenSolver<Eigen::Matrix4d> solver(companion, false);
    double smallest = std::numeric_limits<double>::infinity();
    for (const std::complex<double>& root : solver.eigenvalues()) {
      if (std::abs(root.imag()) <= real * std::abs(root) && root.real() > later)
        smallest = std::min(smallest, root.real());
    }
    return smallest;
  }

  std::vector<Disc<double>> discs_;
};

}  // namespace hybrid_sphere::peers
