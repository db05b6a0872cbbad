#include "motion/dry_friction.hpp"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>

#include "geometry/exact.hpp"
#include "motion/phi.hpp"

namespace hybrid_sphere {
namespace {

using exact::DoubleDouble;

DoubleDouble square(double x) { return exact::two_product(x, x); }

DoubleDouble difference(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble values = exact::two_difference(a.value, b.value);
  return {values.value, values.remainder + (a.remainder - b.remainder)};
}

// A - abs(b), good to a few ulp of itself however close both are.
double gap_between(double friction, const Vector2d& drive) {
  const double size = stable_norm(drive);
  int exponent = 0;
  std::frexp(std::max(friction, size), &exponent);
  const DoubleDouble squares = difference(
      difference(square(std::ldexp(friction, -exponent)), square(std::ldexp(drive.x(), -exponent))),
      square(std::ldexp(drive.y(), -exponent)));
  const double sum = std::ldexp(friction, -exponent) + std::ldexp(size, -exponent);
  return std::ldexp((squares.value + squares.remainder) / sum, exponent);
}

// Components of w across and along b != 0, the first exactly 0 where they are parallel. The products are
// taken of numbers near 1, so that they do not underflow.
struct Components {
  double across;
  double along;
};

Components components(const Vector2d& w, const Vector2d& b) {
  const double strength = stable_norm(b);
  if (strength == 0) return {0, stable_norm(w)};
  const int of_w = std::ilogb(stable_norm(w));
  const int of_b = std::ilogb(strength);
  const double scale = std::ldexp(strength, -of_b);
  const auto scaled = [](double x, int exponent) { return std::ldexp(x, -exponent); };
  const Vector2d p(scaled(w.x(), of_w), scaled(w.y(), of_w));
  const Vector2d q(scaled(b.x(), of_b), scaled(b.y(), of_b));
  return {std::ldexp(exact::difference_of_products(q.x(), p.y(), q.y(), p.x()) / scale, of_w),
          std::ldexp(exact::difference_of_products(q.x(), p.x(), -q.y(), p.y()) / scale, of_w)};
}

// sin^2 of half the angle between the lines of w_0 and b: with less than that w is parallel to b, and the
// exponentials that let the angle grow would leave the range of numbers.
constexpr double least_sine = 0x1p-700;

// (1 - e^(-rate time))/rate
double decayed(double rate, double time) { return time * phi1(-rate * time); }

struct DecayFactors {
  double passed;  ///< (1 - e^(-rate time))/rate
  double left;    ///< e^(-rate time)
};
DecayFactors decay_of(double rate, double time) {
  const double x = -rate * time;
  const double change = std::expm1(x);
  return {x == 0 ? time : time * (change / x), change > -0.5 ? 1 + change : std::exp(x)};
}

}  // namespace

DryFriction::DryFriction(const Vector2d& start, const Vector2d& drive, double friction)
    : start_(start), drive_(drive), friction_(friction) {
  const double strength = stable_norm(drive);
  size_ = stable_norm(start);
  if (size_ == 0) {
    const double excess = strength > 0 ? -gap_between(friction, drive) : 0;
    if (excess > 0) begin_straight(drive / strength, excess);
    return;
  }
  if (friction == 0) {
    direction_ = start / size_;
    start_derivative_ = drive;
    end_ = never;
    return;
  }
  Curved& c = curved_;
  const auto [cross, along_size] = components(start, drive);
  c.across_size = std::abs(cross);
  const double larger = size_ + std::abs(along_size);
  c.cosine = 0.5 * (larger / size_);
  c.sine = 0.5 * (c.across_size / size_) * (c.across_size / larger);
  if (c.sine <= least_sine) {
    begin_straight(start / size_, strength == 0    ? -friction
                                  : along_size > 0 ? -gap_between(friction, drive)
                                                   : -(friction + strength));
    return;
  }
  if (along_size < 0) std::swap(c.cosine, c.sine);
  straight_ = false;
  c.along = drive / strength;
  c.across = cross > 0 ? turned(c.along) : Vector2d(-turned(c.along));
  c.gap = gap_between(friction, drive);
  c.sum = friction + strength;
  note_inflection();
  end_ = c.gap > 0 ? size_ * (c.cosine / c.gap + c.sine / c.sum) : never;
  start_derivative_ = drive - friction * (start / size_);
}

/// Where t(M), with gap < 0, turns from concave to convex.
void DryFriction::note_inflection() {
  const Curved& c = curved_;
  if (c.gap >= 0) return;
  const double m = 0.5 * std::log((c.sum / -c.gap) * (c.sine / c.cosine)) / (0.5 * (c.sum - c.gap));
  const double most = std::min(DBL_MAX, 0x1p+1000 / c.sum);  // products with the rates are numbers
  curved_.inflection = std::clamp(m, 0.0, most);
  curved_.inflection_time = c.cosine * decayed(c.gap, m) + c.sine * decayed(c.sum, m);
}

void DryFriction::begin_straight(const Vector2d& direction, double rate) {
  direction_ = direction;
  start_derivative_ = rate * direction;
  end_ = rate < 0 ? size_ / -rate : never;
}

// The component along b vanishes where cosine e^(-gap M) = sine e^(-sum M).
DryFriction::Corner DryFriction::corner() const {
  const Curved& c = curved_;
  if (straight_) return {0, never};
  const double m = c.sine > c.cosine ? std::log(c.sine / c.cosine) / (c.sum - c.gap) : 0;
  const double time = size_ * (c.cosine * decayed(c.gap, m) + c.sine * decayed(c.sum, m));
  const double left = c.cosine * std::exp(-c.gap * m) + c.sine * std::exp(-c.sum * m);
  return {time, left * (size_ / c.sum)};
}

// M(t): t = size (cosine F(gap) + sine F(sum)), F(q) = (1 - e^(-q M))/q.
double DryFriction::regular_time(double time) const {
  return time > 0.5 * end_ ? late_regular_time(end_ - time) : early_regular_time(time);
}

// Newton's method from a side from which it is monotone. t(M) is concave up to its point of inflection (that
// is everywhere if gap >= 0), convex after it. Where w all but vanishes there t(M) is so flat that rounding
// would throw a step far away: none leaves the side on which it begins.
double DryFriction::early_regular_time(double time) const {
  const Curved& c = curved_;
  const double scaled = time / size_;
  // Below the root: both terms are at most linear, the second at most sine/sum.
  double m = c.gap >= 0 ? scaled : 0;
  const double rest = scaled - c.sine / c.sum;
  if (c.gap >= 0 && rest > c.cosine * m) m = rest / c.cosine;
  double least = m;
  double most = std::min(DBL_MAX, 0x1p+1000 / c.sum);  // products with the rates are numbers
  if (c.gap < 0) {
    // Above the root from the first term alone.
    const bool above = c.inflection == 0 || c.inflection_time < scaled;
    if (above) m = std::log1p(-c.gap * (scaled / c.cosine)) / -c.gap;
    (above ? least : most) = c.inflection;
  }
  double last = never;
  for (int i = 0; i < 200; ++i) {
    m = std::clamp(m, least, most);
    const DecayFactors slow = decay_of(c.gap, m);
    const DecayFactors fast = decay_of(c.sum, m);
    const double missing = scaled - (c.cosine * slow.passed + c.sine * fast.passed);
    const double step = missing / (c.cosine * slow.left + c.sine * fast.left);
    if (!(std::abs(step) < last) && std::abs(step) <= 0x1p-40 * m) break;
    m += step;
    last = std::abs(step);
    // The next step is at most this, as abs(t'') <= sum t'.
    if (0.5 * c.sum * step * step <= 0.5 * DBL_EPSILON * m) break;
  }
  return std::clamp(m, least, most);
}

// The logarithm of the remaining time is a convex function of M and falls with a slope between -sum and -gap:
// Newton's method is monotone from below.
double DryFriction::late_regular_time(double remaining) const {
  const Curved& c = curved_;
  const double first = size_ * (c.cosine / c.gap);
  const double second = size_ * (c.sine / c.sum);
  const double target = std::log(remaining);
  double m = std::max({0.0, (std::log(first) - target) / c.gap, (std::log(second) - target) / c.sum});
  double last = never;
  for (int i = 0; i < 200; ++i) {
    const double slow = first * std::exp(-c.gap * m);
    const double fast = second * std::exp(-c.sum * m);
    const double step = (std::log((slow + fast) / remaining)) * (slow + fast) / (c.gap * slow + c.sum * fast);
    if (!(std::abs(step) < last) && std::abs(step) <= 0x1p-40 * m) break;
    m += step;
    last = std::abs(step);
    // The next step is at most this: the second derivative is at most a quarter of (sum - gap)^2.
    const double apart = (c.sum - c.gap) * step;
    if (apart * apart <= 4 * DBL_EPSILON * c.gap * m) break;
  }
  return m;
}

DryFriction::Value DryFriction::at(double time) const {
  const Curved& c = curved_;
  const bool over = time >= end_;
  const double t = std::min(time, end_);
  if (straight_) {
    const Vector2d value = over ? Vector2d(0, 0) : Vector2d(start_ + t * start_derivative_);
    Vector2d direction = direction_;
    if (friction_ == 0 && !value.isZero(0)) direction = value / stable_norm(value);
    return {value, direction, t * (start_ + 0.5 * t * start_derivative_), start_derivative_};
  }
  if (t == 0) return {start_, start_ / size_, Vector2d::Zero(), start_derivative_};
  const double m = over ? never : regular_time(t);
  const auto decay = [&](double rate) { return over ? DecayFactors{1 / rate, 0} : decay_of(rate, m); };
  const DecayFactors of_gap = decay(c.gap);
  const DecayFactors of_sum = decay(c.sum);
  const double fast = c.sine * of_sum.left;
  double slow = c.cosine * of_gap.left;
  double slow_sum = c.cosine * of_gap.passed;
  if (-c.gap * m > 1) {
    // From t itself: the exponential would amplify the rounding of M.
    slow_sum = t / size_ - c.sine * of_sum.passed;
    slow = c.cosine - c.gap * slow_sum;
  }
  const double side = over ? 0 : c.across_size * std::exp(-friction_ * m);
  const double fast_square = 0.5 * (c.sine * of_sum.passed) * (c.sine + fast);
  const double along = size_ * (size_ * (0.5 * slow_sum * (c.cosine + slow) - fast_square));
  const double slow_across = c.cosine * decay(friction_ + c.gap).passed;
  const double fast_across = c.sine * decay(friction_ + c.sum).passed;
  const double across = c.across_size * (size_ * (slow_across + fast_across));
  Value now;
  now.value = size_ * (slow - fast) * c.along + side * c.across;
  now.direction = c.along;
  if (!over) now.direction = (size_ * (slow - fast) * c.along + side * c.across) / (size_ * (slow + fast));
  now.integral = along * c.along + across * c.across;
  now.derivative = drive_ - friction_ * now.direction;
  return now;
}

// With n = abs(w) and e = w/n the coefficients follow from n^2 = w.w, n e = w and w' = b - A e.
polynomials::Powers<2> DryFriction::expand(const Value& now, double length) const {
  constexpr int size = polynomials::size;
  constexpr double rounding = 4 * DBL_EPSILON;
  std::array<Vector2d, size> w, e;
  std::array<double, size> n;
  polynomials::Powers<2> powers;
  w[0] = now.value;
  e[0] = now.direction;
  n[0] = w[0].norm();
  const double inverse = 1 / n[0];
  for (std::size_t k = 0;; ++k) {
    if (k > 0) {
      const auto term = [&](std::size_t i) { return w[i].dot(w[k - i]) - n[i] * n[k - i]; };
      double square = w[0].dot(w[k]);
      Vector2d product = w[k];
      for (std::size_t i = 1; i < k; ++i) product -= n[i] * e[k - i];
      for (std::size_t i = 1; 2 * i < k; ++i) square += term(i);
      if (k % 2 == 0) square += 0.5 * term(k / 2);
      n[k] = inverse * square;
      e[k] = inverse * (product - n[k] * e[0]);
    }
    powers.col(static_cast<Eigen::Index>(k)) = w[k];
    if (k + 1 == size) return powers;
    const double step = length / static_cast<double>(k + 1);
    w[k + 1] = -step * friction_ * e[k];
    if (k > 0) continue;
    // Where friction balances the drive, what is left of both is rounding, and would turn a w that is as
    // small.
    w[1] += step * drive_;
    if (w[1].norm() <= rounding * length * friction_) w[1].setZero();
  }
}

}  // namespace hybrid_sphere
