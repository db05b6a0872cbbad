#include "hybrid_sphere/solver/departure.hpp"

#include <cfloat>
#include <cmath>

namespace hybrid_sphere::solver {

Departure::Departure(const Equations& equations)
    : slides_(equations.regime() == Regime::sliding),
      affine_(equations.momentum_is_affine()),
      decay_(equations.decay()) {
  for (Coefficients* c : {&d_, &velocity_, &momentum_, &w_, &e_}) c->fill(Vector2d::Zero());
  const Instant now = equations.instant(equations.start(Vector2d::Zero()));
  momentum_[0] = (1 - equations.dynamics().kappa) * now.velocity + equations.dynamics().kappa * now.nu;
  for (int n = 0; n <= order; ++n) add_order(equations, n);
  end_ = reach();
}

// Coefficient n of -c abs(v) v, given those of v up to n. With v = tau^m V, V_0 != 0, abs(v) = tau^m abs(V)
// is a power series too: 2 s_m s_n = (v.v)_{m+n} - sum_{k=m+1..n-1} s_k s_{m+n-k}.
Vector2d Departure::drag(double coefficient, int n) {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  if (leading_ < 0 && velocity_[at(n)].isZero(0)) return Vector2d::Zero();
  if (leading_ < 0) leading_ = n;
  const int m = leading_;
  double square = 0;
  for (int k = m; k <= n; ++k) square += velocity_[at(k)].dot(velocity_[at(m + n - k)]);
  if (n == m) {
    speed_[at(n)] = std::sqrt(square);
  } else {
    for (int k = m + 1; k < n; ++k) square -= speed_[at(k)] * speed_[at(m + n - k)];
    speed_[at(n)] = square / (2 * speed_[at(m)]);
  }
  Vector2d sum = Vector2d::Zero();
  for (int k = m; k <= n - m; ++k) sum += speed_[at(k)] * velocity_[at(n - k)];
  return -coefficient * sum;
}

// Coefficient n of B, given those of w up to n and of everything else up to n - 1.
Vector2d Departure::forcing(const Equations& equations, int n) {
  const Dynamics& dynamics = equations.dynamics();
  const double kappa = dynamics.kappa;
  const double rate = equations.turntable_rate();
  const auto i = static_cast<std::size_t>(n);
  if (n > 0) d_[i] = velocity_[i - 1] / n;
  const Vector2d ground = n == 0 ? equations.ground(Vector2d::Zero()) : Vector2d(rate * turned(d_[i]));
  const Vector2d sigma = w_[i] + ground;
  velocity_[i] = slides_ ? Vector2d(momentum_[i] + kappa * sigma) : sigma;
  const Vector2d nu = slides_ ? Vector2d(momentum_[i] - (1 - kappa) * sigma) : w_[i];
  Vector2d force = -dynamics.translational_drag * velocity_[i] - dynamics.spring_rate * d_[i];
  if (dynamics.quadratic_drag != 0) force += drag(dynamics.quadratic_drag, n);
  Vector2d spin = -dynamics.rotational_drag * nu;
  if (n == 0) {
    force += dynamics.free + dynamics.spring_rate * dynamics.spring_center;
    spin += dynamics.spin;
  }
  const Vector2d rolling = (1 - kappa) * force + kappa * spin;
  if (slides_ && n < order) momentum_[i + 1] = rolling / (n + 1);
  const Vector2d carried = rate * turned(velocity_[i]);
  return slides_ ? Vector2d(force - spin - carried) : Vector2d(rolling - (1 - kappa) * carried);
}

void Departure::add_order(const Equations& equations, int n) {
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  for (int k = 1; k <= n; ++k) w_[at(n)] += rho_[at(k)] * e_[at(n - k)];
  const Vector2d forcing = this->forcing(equations, n);
  if (n == 0) {
    const double length = forcing.norm();
    if (length > 0) e_[0] = forcing / length;
    // A few rounding errors of B do not tell abs(B) from A.
    rho_[1] = length - decay_ > 16 * DBL_EPSILON * length ? length - decay_ : 0;
    return;
  }
  const Vector2d along = e_[0];
  const Vector2d across = turned(along);
  Vector2d rest = forcing;
  for (int k = 2; k <= n; ++k) rest -= (n + 1) * rho_[at(k)] * e_[at(n + 1 - k)];
  double parallel = 0;
  for (int k = 1; k < n; ++k) parallel -= 0.5 * e_[at(k)].dot(e_[at(n - k)]);
  const double denominator = decay_ + (n + 1) * rho_[1];
  const double perpendicular = denominator > 0 ? rest.dot(across) / denominator : 0;
  e_[at(n)] = parallel * along + perpendicular * across;
  rho_[at(n + 1)] = (rest.dot(along) - (decay_ + (n + 1) * rho_[1]) * parallel) / (n + 1);
}

// The last coefficients have to be below rounding against the leading ones.
double Departure::reach() const {
  const auto leading = [this](double t) { return (std::abs(rho_[1]) + std::abs(rho_[2]) * t) * t; };
  double t = 0x1p+200;
  for (int halvings = 0; halvings < 1200; ++halvings, t *= 0.5) {
    bool exact = true;
    for (const int n : {order - 1, order}) {
      const double power = std::pow(t, n);
      const auto i = static_cast<std::size_t>(n);
      exact = exact && e_[i].norm() * power <= 0.5 * DBL_EPSILON &&
              w_[i].norm() * power <= 0.5 * DBL_EPSILON * leading(t);
    }
    if (exact && sum(t).head<2>().matrix().dot(e_[0]) > 0) return t;
  }
  return 0;
}

State Departure::sum(double tau) const {
  Vector2d w = Vector2d::Zero();
  Vector2d d = Vector2d::Zero();
  Vector2d p_c = Vector2d::Zero();
  for (std::size_t i = w_.size(); i-- > 0;) {
    w = w_[i] + tau * w;
    d = d_[i] + tau * d;
    p_c = momentum_[i] + tau * p_c;
  }
  State y = State::Zero();
  y.head<2>() = w.array();
  y.segment<2>(2) = d.array();
  if (slides_ && !affine_) y.segment<2>(4) = p_c.array();
  y[6] = tau;
  return y;
}

State Departure::at(double tau) const { return sum(tau); }

Vector2d Departure::turning(double tau) const {
  Vector2d sum = Vector2d::Zero();
  for (std::size_t i = e_.size() - 1; i > 0; --i) sum = static_cast<double>(i) * e_[i] + tau * sum;
  return sum;
}

double Departure::turning_bound(int derivative) const {
  double sum = 0;
  for (int n = derivative; n <= order; ++n) {
    const double factor = derivative == 1 ? n : n * (n - 1);
    sum += factor * e_[static_cast<std::size_t>(n)].norm() * std::pow(end_, n - derivative);
  }
  return sum;
}

}  // namespace hybrid_sphere::solver
