#include "mechanics/saddle_point.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "mechanics/decompositions/cholesky.hpp"
#include "mechanics/decompositions/pivoted_qr.hpp"

namespace hybrid_sphere::mechanics {
namespace {

// A row counts as dependent where this part of it or less is new. Rows that are equal come out of a user's
// formulas with a few roundings each, of an angle of 1000 rad with 1000; what is left of 1e16 is for x.
constexpr double rank_tolerance = 0x1p-36;

// Relative error of gamma, in units of the terms it is made of.
constexpr double gamma_tolerance = 0x1p-42;

// A row has a part in a contradiction where its residual is this part or more of the largest.
constexpr double conflict_part = 0x1p-20;

// A pivot of a Cholesky decomposition is noise up to this, in units of the matrix's largest element.
double pivot_tolerance(Index size) { return 16 * static_cast<double>(size) * DBL_EPSILON; }

/// k with x * 2^-k in [1, 2), as far as 2^k and 2^-k are finite, for any x.
int exponent_of(double x) { return std::clamp(std::ilogb(x), -1023, 1023); }

/// 2^k with x * 2^k in [1, 2).
double power_to_one(double x) { return std::ldexp(1.0, -exponent_of(x)); }

/// 2^k with x * 4^k in [1, 4).
double power_to_one_squared(double x) {
  const int exponent = exponent_of(x);
  return std::ldexp(1.0, -(exponent - (exponent & 1)) / 2);
}

}  // namespace

struct SaddlePoint::Impl {
  Vector scale;        // d: x = d times scaled x (n)
  Vector by_mass;      // the part of it that M alone says (n)
  Vector row_scale;    // scaled row = row_scale times C d (g)
  Matrix rows;         // scaled C, transposed (n x g)
  Matrix hessian;      // scaled M or K (n x n)
  PivotedQr qr;        // of rows
  Matrix q;            // its Q (n x n): the row space, then the kernel
  Matrix image;        // hessian times the kernel
  Matrix reduced;      // on the kernel
  Vector diagonal;     // of hessian (n)
  Vector alone;        // what `diagonal` alone gives to the diagonal of `reduced`
  Cholesky cholesky;   // of reduced
  Vector force;        // scaled h (n)
  Vector target;       // scaled gamma (g)
  Vector x;            // scaled (n)
  Vector rest;         // hessian x - force (n)
  Vector components;   // in columns of q (n)
  Vector multipliers;  // of the scaled rows (g)
  Index rank = 0;
  double regularity = 0;
  std::vector<Index> conflict;

  Index n() const { return rows.rows(); }
  Index g() const { return rows.cols(); }

  void set_scales(const Matrix& mass, const Matrix& gradient);
  void tie_light_velocities(const Matrix& gradient);
  void decompose(const Matrix& mass, const Matrix& gradient);
  bool reduce();
  Outcome solve(const Vector& h, const Vector& gamma, const Vector* gamma_size, bool least_squares, Vector& y,
                Vector& result);
  void complete(Index rank_of_rows);
  void find();
  bool has_nearly_parallel_rows() const;
  void refine();
  Outcome solve_regular(Vector& y);
  Outcome solve_redundant(const Vector* gamma_size, bool least_squares, Vector& y);
  bool is_inconsistent(const Matrix& range, const Vector* gamma_size);
};

// Velocities with mass have their scale from M. The scale of one without is such that its column of C is as
// large as the rest of a row that it is in.
void SaddlePoint::Impl::set_scales(const Matrix& mass, const Matrix& gradient) {
  scale.resize(mass.rows());
  row_scale.resize(gradient.rows());
  for (Index s = 0; s < scale.size(); ++s) {
    scale[s] = mass(s, s) > 0 ? power_to_one_squared(mass(s, s)) : 0;
  }
  const auto length = [&](Index b) {
    double sum = 0;
    for (Index s = 0; s < scale.size(); ++s) sum += std::abs(gradient(b, s)) * scale[s];
    return sum;
  };
  if ((scale.array() == 0).any()) {
    for (Index b = 0; b < row_scale.size(); ++b) {
      row_scale[b] = length(b);
      if (row_scale[b] == 0) row_scale[b] = gradient.row(b).lpNorm<Eigen::Infinity>();
    }
    for (Index s = 0; s < scale.size(); ++s) {
      if (scale[s] > 0) continue;
      double largest = 0;
      for (Index b = 0; b < row_scale.size(); ++b) {
        if (row_scale[b] > 0) largest = std::max(largest, std::abs(gradient(b, s)) / row_scale[b]);
      }
      scale[s] = largest > 0 ? power_to_one(largest) : 1;
    }
  }
  tie_light_velocities(gradient);
  for (Index b = 0; b < row_scale.size(); ++b) {
    const double size = length(b);
    row_scale[b] = size > 0 ? power_to_one(size) : 1;
  }
}

// A row that is nearly all one velocity's in the metric of M says what that one is, given the others: a
// light axle, a large wheel. In the scale of its mass the others' part of the row would lose figures.
void SaddlePoint::Impl::tie_light_velocities(const Matrix& gradient) {
  constexpr double most = 1024;                  // times the rest of the row
  constexpr double least = 64 * rank_tolerance;  // of it: a smaller rest is taken for rounding
  by_mass = scale;
  for (Index b = 0; b < row_scale.size(); ++b) {
    Index heaviest = 0;
    double largest = 0;
    double sum = 0;
    for (Index s = 0; s < by_mass.size(); ++s) {
      const double part = std::abs(gradient(b, s)) * by_mass[s];
      sum += part;
      if (part <= largest) continue;
      largest = part;
      heaviest = s;
    }
    const double others = sum - largest;
    if (largest <= most * others || others <= least * largest) continue;
    scale[heaviest] = std::min(scale[heaviest], by_mass[heaviest] * power_to_one(largest / others));
  }
}

void SaddlePoint::Impl::decompose(const Matrix& mass, const Matrix& gradient) {
  set_scales(mass, gradient);
  rows.resize(gradient.cols(), gradient.rows());
  rows.noalias() = scale.asDiagonal() * gradient.transpose() * row_scale.asDiagonal();
  rank = 0;
  if (g() == 0) return;
  qr.compute(rows);
  const double least = rank_tolerance * std::abs(qr.r()(0, 0));
  const Index largest_rank = std::min(n(), g());
  while (rank < largest_rank && std::abs(qr.r()(rank, rank)) > least) ++rank;
  qr.evaluate_q(q);
}

/// @return whether `hessian` is positive definite on the kernel of C
bool SaddlePoint::Impl::reduce() {
  const Index free = n() - rank;
  regularity = 1;
  if (free == 0) return true;
  regularity = 0;
  diagonal = hessian.diagonal();
  if (g() == 0) {
    reduced = hessian;
  } else {
    const auto kernel = q.rightCols(free);
    image.noalias() = hessian * kernel;
    reduced.noalias() = kernel.transpose() * image;
    alone.resize(free);
    for (Index s = 0; s < free; ++s) alone[s] = kernel.col(s).cwiseAbs2().dot(diagonal);
  }
  if (!cholesky.compute(reduced)) return false;
  const double least = pivot_tolerance(n()) * hessian.lpNorm<Eigen::Infinity>();
  const Vector& sizes = g() == 0 ? diagonal : alone;
  double smallest = 1;
  for (Index s = 0; s < free; ++s) {
    const double pivot = std::pow(cholesky.l()(s, s), 2);
    if (!(pivot > least)) return false;
    smallest = std::min(smallest, pivot / sizes[s]);
  }
  regularity = smallest;
  return true;
}

SaddlePoint::Outcome SaddlePoint::Impl::solve(const Vector& h, const Vector& gamma, const Vector* gamma_size,
                                              bool least_squares, Vector& y, Vector& result) {
  conflict.clear();
  if (!reduce()) return Outcome::singular;
  force = scale.cwiseProduct(h);
  target = row_scale.cwiseProduct(gamma);
  components.resize(n());
  const Outcome outcome = rank == g() ? solve_regular(y) : solve_redundant(gamma_size, least_squares, y);
  if (outcome != Outcome::inconsistent || least_squares) result = scale.cwiseProduct(x);
  return outcome;
}

/// Completes x, whose part in the row space is given by the first components, by that in the kernel; then
/// the components are those of hessian x - force.
void SaddlePoint::Impl::complete(Index rank_of_rows) {
  const Index free = n() - rank_of_rows;
  if (g() == 0) {
    x = force;
    cholesky.solve(x);
    return;
  }
  x.noalias() = q.leftCols(rank_of_rows) * components.head(rank_of_rows);
  rest = force;
  rest.noalias() -= hessian * x;
  if (free > 0) {
    components.tail(free).noalias() = q.rightCols(free).transpose() * rest;
    auto kernel_part = components.tail(free);
    cholesky.solve(kernel_part);
    x.noalias() += q.rightCols(free) * kernel_part;
  }
  rest.noalias() = hessian * x;
  rest -= force;
  components.head(rank_of_rows).noalias() = q.leftCols(rank_of_rows).transpose() * rest;
}

SaddlePoint::Outcome SaddlePoint::Impl::solve_regular(Vector& y) {
  find();
  if (has_nearly_parallel_rows()) refine();
  y = row_scale.cwiseProduct(multipliers);
  return Outcome::regular;
}

/// x and multipliers from force and target.
void SaddlePoint::Impl::find() {
  multipliers.resize(g());
  if (rank == 0) {
    complete(0);
    return;
  }
  auto head = components.head(rank);
  for (Index i = 0; i < rank; ++i) head[i] = target[qr.column(i)];
  qr.solve_r_transposed(head);
  complete(rank);
  qr.solve_r(head);
  for (Index i = 0; i < rank; ++i) multipliers[qr.column(i)] = head[i];
}

bool SaddlePoint::Impl::has_nearly_parallel_rows() const {
  constexpr double nearly = 1e-2;
  return rank > 0 && std::abs(qr.r()(rank - 1, rank - 1)) < nearly * std::abs(qr.r()(0, 0));
}

// Rows that are nearly parallel lose figures, which a second solution for what the first has left gives back.
// A nearly singular M does not: there the rounding of h decides.
void SaddlePoint::Impl::refine() {
  const Vector first = x;
  const Vector first_multipliers = multipliers;
  force.noalias() -= hessian * x;
  force.noalias() += rows * multipliers;
  target.noalias() -= rows.transpose() * x;
  find();
  x += first;
  multipliers += first_multipliers;
}

// The scaled rows are B (first columns of Q)^T, B of full column rank. C x = gamma in the sense of least
// squares tells contradictions; C^T y is unique.
SaddlePoint::Outcome SaddlePoint::Impl::solve_redundant(const Vector* gamma_size, bool least_squares,
                                                        Vector& y) {
  Matrix basis = Matrix::Zero(g(), rank);
  multipliers.setZero(g());
  Matrix range(g(), g());  // its first columns span the range of C
  if (rank > 0) {
    for (Index i = 0; i < g(); ++i) {
      for (Index k = 0; k < std::min(i + 1, rank); ++k) basis(qr.column(i), k) = qr.r()(k, i);
    }
    PivotedQr decomposition(basis);
    components.head(rank) = decomposition.solve(target);
    decomposition.evaluate_q(range);
  }
  complete(rank);
  const bool refused = is_inconsistent(range.leftCols(rank), gamma_size);
  if (refused && !least_squares) return Outcome::inconsistent;
  if (rank > 0) {
    PivotedQr original(row_scale.cwiseInverse().asDiagonal() * basis);
    Matrix least = Matrix::Zero(g(), 1);  // solves basis^T y = components
    auto part = least.col(0).head(rank);
    for (Index i = 0; i < rank; ++i) part[i] = components[original.column(i)];
    original.solve_r_transposed(part);
    original.apply_q(least);
    multipliers = least.col(0);
  }
  y = multipliers;
  return refused ? Outcome::inconsistent : Outcome::redundant;
}

/// Compares the residual of C x = gamma with what errors of gamma and of C let it be, carried over by the
/// projector onto the complement of C's range. The residual has a part in every row that contradicts others.
bool SaddlePoint::Impl::is_inconsistent(const Matrix& range, const Vector* gamma_size) {
  Vector error(g());
  for (Index b = 0; b < g(); ++b) {
    const double size = std::abs(target[b]) + (gamma_size ? std::abs((*gamma_size)[b]) * row_scale[b] : 0);
    error[b] = gamma_tolerance * size + rank_tolerance * rows.col(b).cwiseAbs().dot(x.cwiseAbs());
  }
  Matrix projector = Matrix::Identity(g(), g());
  if (rank > 0) projector.noalias() -= range * range.transpose();
  const Vector residual = projector * target;
  const double rounding = 16 * static_cast<double>(g()) * DBL_EPSILON;  // of the projector
  error = (projector.cwiseAbs() * error).array() + rounding * target.lpNorm<1>();
  if (!(residual.array().abs() > error.array()).any()) return false;
  const double least = conflict_part * residual.lpNorm<Eigen::Infinity>();
  for (Index b = 0; b < g(); ++b) {
    if (std::abs(residual[b]) > std::max(least, error[b])) conflict.push_back(b);
  }
  return true;
}

SaddlePoint::SaddlePoint() : impl_(std::make_unique<Impl>()) {}
SaddlePoint::~SaddlePoint() = default;
SaddlePoint::SaddlePoint(SaddlePoint&&) noexcept = default;
SaddlePoint& SaddlePoint::operator=(SaddlePoint&&) noexcept = default;

SaddlePoint::Outcome SaddlePoint::solve(const Matrix& mass, const Matrix& gradient, const Vector& h,
                                        const Vector& gamma, Vector& x, Vector& y, const Vector* gamma_size) {
  Impl& impl = *impl_;
  impl.decompose(mass, gradient);
  impl.hessian.noalias() = impl.scale.asDiagonal() * mass * impl.scale.asDiagonal();
  return impl.solve(h, gamma, gamma_size, false, y, x);
}

SaddlePoint::Outcome SaddlePoint::solve_step(const Matrix& mass, const Matrix& hessian,
                                             const Matrix& gradient, const Vector& h, const Vector& gamma,
                                             const Vector& gamma_size, Vector& x, Vector& y) {
  Impl& impl = *impl_;
  impl.decompose(mass, gradient);
  impl.hessian.noalias() = impl.scale.asDiagonal() * hessian * impl.scale.asDiagonal();
  return impl.solve(h, gamma, &gamma_size, true, y, x);
}

Index SaddlePoint::find_rank(const Matrix& mass, const Matrix& gradient) {
  impl_->decompose(mass, gradient);
  return impl_->rank;
}

Index SaddlePoint::rank() const { return impl_->rank; }

std::vector<Index> SaddlePoint::independent_rows() const {
  std::vector<Index> rows;
  for (Index i = 0; i < impl_->rank; ++i) rows.push_back(impl_->qr.column(i));
  std::sort(rows.begin(), rows.end());
  return rows;
}

const Vector& SaddlePoint::scale() const { return impl_->scale; }

double SaddlePoint::length(const Vector& x) const {
  double sum = 0;
  for (Index s = 0; s < x.size(); ++s) {
    const double part = x[s] / impl_->scale[s];
    sum += part * part;
  }
  return std::sqrt(sum);
}

double SaddlePoint::regularity() const { return impl_->regularity; }

double SaddlePoint::mobility(Index i) const {
  const Impl& impl = *impl_;
  const Index free = impl.n() - impl.rank;
  if (free == 0) return 0;
  Vector row = impl.g() == 0 ? Vector(Vector::Unit(free, i)) : Vector(impl.q.row(i).tail(free).transpose());
  impl.cholesky.solve_l(row);
  return impl.scale[i] * row.norm();
}

const std::vector<Index>& SaddlePoint::conflict() const { return impl_->conflict; }

}  // namespace hybrid_sphere::mechanics
