#include "motion/slip_onset.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "integration/power_of_two.hpp"
#include "motion/speed_bound.hpp"

namespace hybrid_sphere::numeric {

namespace {

// What grows by less than this part of what drives it is held: it would have to be followed in steps of a
// hundred millionth of the time that it takes to double.
constexpr double told = 0x1p-40;

std::size_t place(int i) { return static_cast<std::size_t>(i); }

}  // namespace

SlipOnset::Kind SlipOnset::kind_of(const Equations& equations, const Vector2d& slip, const Vector2d& nu) {
  switch (equations.form()) {
    case EquationForm::sliding: return Kind::slip;
    case EquationForm::skidding: return Kind::slip_of_skid;
    case EquationForm::resisted_sliding: break;
    case EquationForm::free:
    case EquationForm::rolling:
    case EquationForm::resisted_rolling: return Kind::rolling;
  }
  if (slip.isZero(0) && nu.isZero(0)) return Kind::both;
  return slip.isZero(0) ? Kind::slip_beside_roll : Kind::roll_beside_slip;
}

SlipOnset::SlipOnset(const Equations& equations, const Vector2d& slip, const Vector2d& nu)
    : kind_(kind_of(equations, slip, nu)),
      affine_(equations.momentum_is_affine()),
      decay_(kind_ == Kind::roll_beside_slip ? equations.roll_decay() : equations.decay()) {
  for (Coefficients* c : {&d_, &velocity_, &momentum_, &w_, &e_, &other_, &n_}) c->fill(Vector2d::Zero());
  if (kind_ == Kind::both) {
    begin_both(equations);
    return;
  }
  const bool slides_resisted = equations.form() == EquationForm::resisted_sliding;
  const Instant now =
      equations.instant(slides_resisted ? equations.start(slip, nu) : equations.start(Vector2d::Zero()));
  momentum_[0] = (1 - equations.dynamics().kappa) * now.velocity + equations.dynamics().kappa * now.nu;
  velocity_[0] = now.velocity;
  add_orders(equations);
  if (leading_ == 0) drag_from_rest(equations);
}

void SlipOnset::add_orders(const Equations& equations) {
  add_order(equations, 0);
  add_order(equations, 1);
  choose_unit();
  for (int n = 2; n <= order; ++n) add_order(equations, n);
  if (rho_[1] >= 0) end_ = reach();
}

// In which what goes along, or the velocity that the drag sees, changes by its own size: beside one of
// 1e-30 m/s the last coefficients would else be larger than any number.
void SlipOnset::choose_unit() {
  const auto time = [](double size, double rate) { return size > 0 && rate > 0 ? size / rate : never; };
  const double shortest = std::min(time(other_size_[0], other_[1].norm()),
                                   leading_ == 0 ? time(speed_[0], velocity_[1].norm()) : never);
  if (!(shortest < 1)) return;
  unit_ = integration::power_of_two(shortest);
  double power = 1;
  for (std::size_t n = 0; n <= 2; ++n, power *= unit_) {  // of these some coefficients are known
    for (Coefficients* c : {&d_, &velocity_, &momentum_, &w_, &e_, &other_, &n_}) (*c)[n] *= power;
    other_size_[n] *= power;
    rho_[n] *= power;
    speed_[n] *= power;
  }
}

// The series of abs(v) ends where v has doubled, however slow it is at the start. Without v(0) it goes on for
// longer, as far as rounding hides in w what the drag then lacks.
void SlipOnset::drag_from_rest(const Equations& equations) {
  SlipOnset other = *this;
  other.first_order_ = 1;
  other.leading_ = -1;
  for (Coefficients* c : {&other.d_, &other.w_, &other.e_, &other.other_, &other.n_})
    c->fill(Vector2d::Zero());
  other.unit_ = 1;
  other.add_orders(equations);
  const double coefficient = equations.dynamics().quadratic_drag * velocity_[0].norm();
  const auto unseen = [&](double t) {
    double speed = 0;
    for (int n = 0; n <= order; ++n) speed += other.velocity_[place(n)].norm() * std::pow(t / other.unit_, n);
    const double grown = other.growth(t / other.unit_).norm();
    return grown > DBL_MIN && coefficient * 2 * speed * t <= 0x1p-53 * grown;
  };
  while (other.end_ > end_ && !unseen(other.end_)) other.end_ *= 0.5;
  if (other.end_ > end_) *this = other;
}

// Until the drives have changed by a billionth of what either vector grows by.
void SlipOnset::begin_both(const Equations& equations) {
  constexpr double part = 1e-9;
  const State y = equations.start(Vector2d::Zero(), Vector2d::Zero());
  const Instant now = equations.instant(y);
  const DryVector slip = equations.dry_vector(0, y, now);
  const DryVector nu = equations.dry_vector(1, y, now);
  const Vector2d acceleration = equations.acceleration(y, now);
  // s' = B_s - A e_s + a e_nu and nu' = g + (1 - kappa) A e_s - a e_nu
  const double kappa = equations.dynamics().kappa;
  const Vector2d friction = now.force - acceleration;  // kappa A e_s
  const Vector2d resistance = slip.drive - now.forcing;
  w_[1] = slip.drive - friction / kappa;
  other_[1] = nu.drive - resistance;
  d_[1] = now.velocity;
  d_[2] = 0.5 * acceleration;
  const double of_slip = w_[1].norm();
  const double of_roll = other_[1].norm();
  if (!(of_roll > told * (nu.drive.norm() + equations.roll_decay()))) return;
  if (equations.decay() > 0 && !(of_slip > told * (slip.drive.norm() + equations.decay()))) return;
  const double growth = equations.decay() > 0 ? std::min(of_slip, of_roll) : of_roll;
  const auto change = [&](double duration) {
    const SpeedBound bound(equations, y, duration);
    const ForcingBound forcing(equations, bound);
    return duration * (forcing.force_rate + forcing.spin_rate +
                       std::abs(equations.turntable_rate()) * bound.acceleration);
  };
  end_ = max_time;
  while (end_ > 0 && !(change(end_) <= part * growth)) end_ *= 0.5;
}

// Coefficient n of -c abs(v) v, given those of v up to n. With v = tau^m V, V_0 != 0, abs(v) = tau^m abs(V)
// is a power series too: 2 s_m s_n = (v.v)_{m+n} - sum_{k=m+1..n-1} s_k s_{m+n-k}.
Vector2d SlipOnset::drag(double coefficient, int n) {
  if (leading_ < 0 && (n < first_order_ || velocity_[place(n)].isZero(0))) return Vector2d::Zero();
  if (leading_ < 0) leading_ = n;
  const int m = leading_;
  double square = 0;
  for (int k = m; k <= n; ++k) square += velocity_[place(k)].dot(velocity_[place(m + n - k)]);
  if (n == m) {
    speed_[place(n)] = std::sqrt(square);
  } else {
    for (int k = m + 1; k < n; ++k) square -= speed_[place(k)] * speed_[place(m + n - k)];
    speed_[place(n)] = square / (2 * speed_[place(m)]);
  }
  Vector2d sum = Vector2d::Zero();
  for (int k = m; k <= n - m; ++k) sum += speed_[place(k)] * velocity_[place(n - k)];
  return -coefficient * sum;
}

// Coefficient n of f, given those of v and d.
Vector2d SlipOnset::force(const Equations& equations, int n) {
  const Dynamics& dynamics = equations.dynamics();
  Vector2d force = -dynamics.translational_drag * velocity_[place(n)] - dynamics.spring_rate * d_[place(n)];
  if (dynamics.quadratic_drag != 0) force += drag(dynamics.quadratic_drag, n);
  if (n == 0) force += dynamics.free + dynamics.spring_rate * dynamics.spring_center;
  return force;
}

// Coefficient n of the direction of the other vector: abs(.) from its square, then the quotient.
Vector2d SlipOnset::direction_of_other(int n) {
  double square = 0;
  for (int k = 0; k <= n; ++k) square += other_[place(k)].dot(other_[place(n - k)]);
  if (n == 0) {
    other_size_[0] = std::sqrt(square);
  } else {
    for (int k = 1; k < n; ++k) square -= other_size_[place(k)] * other_size_[place(n - k)];
    other_size_[place(n)] = square / (2 * other_size_[0]);
  }
  Vector2d rest = other_[place(n)];
  for (int k = 1; k <= n; ++k) rest -= other_size_[place(k)] * n_[place(n - k)];
  return rest / other_size_[0];
}

// Beside a rolling velocity that does not vanish: p_c' = (1 - kappa) f + kappa g - kappa a n.
Vector2d SlipOnset::forcing_of_slip(const Equations& equations, int n, const Vector2d& ground) {
  const Dynamics& dynamics = equations.dynamics();
  const double kappa = dynamics.kappa;
  const Vector2d sigma = w_[place(n)] + ground;
  velocity_[place(n)] = momentum_[place(n)] + kappa * sigma;
  other_[place(n)] = momentum_[place(n)] - (1 - kappa) * sigma;
  n_[place(n)] = direction_of_other(n);
  const Vector2d force = this->force(equations, n);
  Vector2d spin = -dynamics.rotational_drag * other_[place(n)];
  if (n == 0) spin += dynamics.spin;
  const Vector2d resistance = equations.roll_decay() * n_[place(n)];
  if (n < order) {
    momentum_[place(n + 1)] = unit_ * ((1 - kappa) * force + kappa * (spin - resistance)) / (n + 1);
  }
  return force - spin - equations.turntable_rate() * turned(velocity_[place(n)]) + resistance;
}

// Beside a slip that does not vanish: v' = f - kappa A n.
Vector2d SlipOnset::forcing_of_roll(const Equations& equations, int n, const Vector2d& ground) {
  const Dynamics& dynamics = equations.dynamics();
  const double kappa = dynamics.kappa;
  other_[place(n)] = velocity_[place(n)] - w_[place(n)] - ground;
  n_[place(n)] = direction_of_other(n);
  const Vector2d friction = equations.decay() * n_[place(n)];
  if (n < order) velocity_[place(n + 1)] = unit_ * (this->force(equations, n) - kappa * friction) / (n + 1);
  Vector2d spin = -dynamics.rotational_drag * w_[place(n)];
  if (n == 0) spin += dynamics.spin;
  return spin + (1 - kappa) * friction;
}

// Coefficient n of B, given those of w up to n and of everything else up to n - 1.
Vector2d SlipOnset::forcing(const Equations& equations, int n) {
  const Dynamics& dynamics = equations.dynamics();
  const double kappa = dynamics.kappa;
  const double rate = equations.turntable_rate();
  const auto i = place(n);
  if (n > 0) d_[i] = unit_ * velocity_[i - 1] / n;
  const Vector2d ground = n == 0 ? equations.ground(Vector2d::Zero()) : Vector2d(rate * turned(d_[i]));
  if (kind_ == Kind::slip_beside_roll) return forcing_of_slip(equations, n, ground);
  if (kind_ == Kind::roll_beside_slip) return forcing_of_roll(equations, n, ground);
  const bool slides = kind_ == Kind::slip;
  const Vector2d sigma = w_[i] + ground;
  velocity_[i] = slides ? Vector2d(momentum_[i] + kappa * sigma) : sigma;
  const Vector2d nu = slides ? Vector2d(momentum_[i] - (1 - kappa) * sigma) : w_[i];
  const Vector2d force = this->force(equations, n);
  if (kind_ == Kind::slip_of_skid) return force - rate * turned(velocity_[i]);
  Vector2d spin = -dynamics.rotational_drag * nu;
  if (n == 0) spin += dynamics.spin;
  const Vector2d rolling = (1 - kappa) * force + kappa * spin;
  if (slides && n < order) momentum_[i + 1] = unit_ * rolling / (n + 1);
  const Vector2d carried = rate * turned(velocity_[i]);
  return slides ? Vector2d(force - spin - carried) : Vector2d(rolling - (1 - kappa) * carried);
}

void SlipOnset::add_order(const Equations& equations, int n) {
  for (int k = 1; k <= n; ++k) w_[place(n)] += rho_[place(k)] * e_[place(n - k)];
  const Vector2d forcing = unit_ * this->forcing(equations, n);
  const double decay = unit_ * decay_;
  if (n == 0) {
    const double length = forcing.norm();
    if (length > 0) e_[0] = forcing / length;
    // What has just lost its grip may have less than A.
    const bool grows = length - decay > told * length;
    const bool held = length < (1 - 0x1p-20) * decay;
    rho_[1] = grows || held ? length - decay : 0;
    return;
  }
  const Vector2d along = e_[0];
  const Vector2d across = turned(along);
  Vector2d rest = forcing;
  for (int k = 2; k <= n; ++k) rest -= (n + 1) * rho_[place(k)] * e_[place(n + 1 - k)];
  double parallel = 0;
  for (int k = 1; k < n; ++k) parallel -= 0.5 * e_[place(k)].dot(e_[place(n - k)]);
  const double denominator = decay + (n + 1) * rho_[1];
  const double perpendicular = denominator > 0 ? rest.dot(across) / denominator : 0;
  e_[place(n)] = parallel * along + perpendicular * across;
  rho_[place(n + 1)] = (rest.dot(along) - (decay + (n + 1) * rho_[1]) * parallel) / (n + 1);
}

// Whether abs(v), which quadratic drag asks for, has no zero but that at the beginning until t: beyond one
// its series would go on with the other sign.
bool SlipOnset::keeps_speed(double t) const {
  if (leading_ < 0) return true;
  double change = 0;
  for (int n = leading_ + 1; n <= order; ++n) {
    change += velocity_[place(n)].norm() * std::pow(t, n - leading_);
  }
  return change <= 0.5 * velocity_[place(leading_)].norm();
}

// The last coefficients have to be below rounding against the leading ones.
double SlipOnset::reach() const {
  const auto leading = [this](double t) { return (std::abs(rho_[1]) + std::abs(rho_[2]) * t) * t; };
  double t = 0x1p+200;
  for (int halvings = 0; halvings < 1200; ++halvings, t *= 0.5) {
    bool exact = true;
    for (const int n : {order - 1, order}) {
      const double power = std::pow(t, n);
      const auto i = static_cast<std::size_t>(n);
      exact = exact && e_[i].norm() * power <= 0.5 * DBL_EPSILON &&
              n_[i].norm() * power <= 0.5 * DBL_EPSILON &&
              other_[i].norm() * power <= 0.5 * DBL_EPSILON * other_size_[0] &&
              w_[i].norm() * power <= 0.5 * DBL_EPSILON * leading(t);
    }
    double change = 0;  // of what goes along, whose direction is no series beyond its zero
    for (int n = 1; n <= order; ++n) {
      if (!other_[place(n)].isZero(0)) change += other_[place(n)].norm() * std::pow(t, n);
    }
    if (exact && change <= 0.5 * other_size_[0] && keeps_speed(t) && growth(t).dot(e_[0]) > 0)
      return t * unit_;
  }
  return 0;
}

namespace {

template <class Coefficients>
Vector2d polynomial(const Coefficients& coefficients, double tau) {
  if (tau == 0) return coefficients[0];  // whatever the others are
  Vector2d sum = Vector2d::Zero();
  for (std::size_t i = coefficients.size(); i-- > 0;) sum = coefficients[i] + tau * sum;
  return sum;
}

}  // namespace

Vector2d SlipOnset::growth(double tau) const { return polynomial(w_, tau); }

State SlipOnset::sum(double tau) const {
  State y = State::Zero();
  const Vector2d w = polynomial(w_, tau);
  set_pair(y, 0, w);
  set_pair(y, 2, polynomial(d_, tau));
  if (kind_ == Kind::slip && !affine_) set_pair(y, 4, polynomial(momentum_, tau));
  if (kind_ == Kind::slip_beside_roll || kind_ == Kind::both) {
    set_pair(y, 4, polynomial(other_, tau));
  }
  if (kind_ == Kind::roll_beside_slip) {
    set_pair(y, 0, polynomial(other_, tau));
    set_pair(y, 4, w);
  }
  return y;
}

State SlipOnset::at(double tau) const {
  State y = sum(tau / unit_);
  y[6] = tau;
  return y;
}

Vector2d SlipOnset::turning(double tau) const {
  Vector2d sum = Vector2d::Zero();
  for (std::size_t i = e_.size() - 1; i > 0; --i) sum = static_cast<double>(i) * e_[i] + tau / unit_ * sum;
  return sum / unit_;
}

double SlipOnset::turning_bound(int derivative) const {
  double sum = 0;
  for (int n = derivative; n <= order; ++n) {
    const double factor = derivative == 1 ? n : n * (n - 1);
    sum += factor * e_[static_cast<std::size_t>(n)].norm() * std::pow(end_ / unit_, n - derivative);
  }
  return sum / (derivative == 1 ? unit_ : unit_ * unit_);
}

}  // namespace hybrid_sphere::numeric
