#include <cmath>

#include "catalogue/elementary.hpp"
#include "catalogue/entry_helpers.hpp"
#include "catalogue/sphere_systems.hpp"
#include "hybrid_sphere/mechanics/by_hand.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::catalogue {
namespace chaplygin_carriage_parts {
namespace {

constexpr const char* description =
    R"(Chaplygin's carriage: a body on two independent wheels, let down on the ground while it glides.

coordinates  x, y, theta          middle of the axle [m], heading [rad]
             phi_left, phi_right  turns of the wheels [rad]
L            m (V_x^2 + V_y^2)/2 + I theta'^2/2 + I_w (phi_left'^2 + phi_right'^2)/2
             V: velocity of the mass centre of all, a ahead of the axle,
               V = (x' - a theta' sin theta, y' + a theta' cos theta)
Q            none
constraints  from t_switch on, three at once; wheels of the radius r at the distance b from the middle,
               no_side_slip  f = -x' sin theta + y' cos theta
               left_wheel    f = x' cos theta + y' sin theta - b theta' - r phi_left'
               right_wheel   f = x' cos theta + y' sin theta + b theta' - r phi_right'

Watch the carriage swing until its mass centre is ahead: it runs straight in the end, though no force acts that
damps it. With a < 0 it turns round. The impulse sets the wheels going.

known        all of it, with u = x' cos theta + y' sin theta, w = theta', U = -x' sin theta + y' cos theta,
               M = m + 2 I_w/r^2,  J = I + m a^2 + 2 I_w b^2/r^2
             impulse     M u = m u1 + I_w (phi_left1' + phi_right1')/r
                         J w = (I + m a^2) w1 + m a U1 + I_w b (phi_right1' - phi_left1')/r
             stage 3     M u' = m a w^2,  J w' = -m a u w:  Chaplygin's sleigh of other masses. (u, w sqrt(J/M))
                         keeps its length c and turns by psi' = -(m a/J) c sin psi to the direction of u
                         r phi' = u -+ b w;  theta and phi in closed form, x and y by quadrature
                         lambda = (m (u w + a w'), -I_w (u' - b w')/r^2, -I_w (u' + b w')/r^2)
source       S. A. Chaplygin, Mat. Sb. 28 (1911); Neimark and Fufaev, Dynamics of Nonholonomic Systems (1972).
limits       none.
)";

Model automatic(const Values& p) {
  const double m = p["m"], I = p["I"], I_w = p["I_w"], a = p["a"], b = p["b"], r = p["r"];
  System<5> carriage(
      {"x", "y", "theta", "phi_left", "phi_right"}, [=](auto /*t*/, const auto& q, const auto& v) {
        using std::cos, std::sin;
        const auto V_x = v[0] - a * v[2] * sin(q[2]);
        const auto V_y = v[1] + a * v[2] * cos(q[2]);
        return m / 2 * (V_x * V_x + V_y * V_y) + I / 2 * v[2] * v[2] + I_w / 2 * (v[3] * v[3] + v[4] * v[4]);
      });
  const auto sideways = [](auto /*t*/, const auto& q, const auto& v) {
    using std::cos, std::sin;
    return v[1] * cos(q[2]) - v[0] * sin(q[2]);
  };
  const auto left = [=](auto /*t*/, const auto& q, const auto& v) {
    using std::cos, std::sin;
    return v[0] * cos(q[2]) + v[1] * sin(q[2]) - b * v[2] - r * v[3];
  };
  const auto right = [=](auto /*t*/, const auto& q, const auto& v) {
    using std::cos, std::sin;
    return v[0] * cos(q[2]) + v[1] * sin(q[2]) + b * v[2] - r * v[4];
  };
  const Between when = from(p["t_switch"]);
  return carriage.constrain("no_side_slip", sideways, when)
      .constrain("left_wheel", left, when)
      .constrain("right_wheel", right, when);
}

// A row (x, y, arm) of the velocities of the axle, and -r of one wheel.
std::shared_ptr<const ConstraintFunction> row_by_hand(bool across, double arm, double r, Index wheel) {
  return constraint_by_hand(
      1, [=](double, const Vector& q, const Vector& v, const Vector& rate, ConstraintTerms& terms) {
        const double c = std::cos(q[2]), s = std::sin(q[2]);
        const double x = across ? -s : c, y = across ? c : s;
        terms.gradient << x, y, arm, 0, 0;
        terms.gradient(0, wheel) -= r;
        terms.value = terms.gradient * v;
        terms.gamma << (y * v[0] - x * v[1]) * rate[2];
      });
}

Model by_hand(const Values& p) {
  const double m = p["m"], I = p["I"], I_w = p["I_w"], a = p["a"], b = p["b"], r = p["r"];
  const auto fill = [=](double, const Vector& q, const Vector& v, MotionTerms& terms) {
    const double c = std::cos(q[2]), s = std::sin(q[2]);
    terms.rate = v;
    terms.mass.setZero();
    terms.mass.diagonal() << m, m, I + m * a * a, I_w, I_w;
    terms.mass(0, 2) = terms.mass(2, 0) = -m * a * s;
    terms.mass(1, 2) = terms.mass(2, 1) = m * a * c;
    terms.momentum.noalias() = terms.mass * v;
    terms.lagrangian = v.dot(terms.momentum) / 2;
    terms.force << m * a * v[2] * v[2] * c, m * a * v[2] * v[2] * s, 0, 0, 0;
  };
  const Between when = from(p["t_switch"]);
  return System<5>({"x", "y", "theta", "phi_left", "phi_right"},
                   {"x_dot", "y_dot", "theta_dot", "phi_left_dot", "phi_right_dot"},
                   equations_by_hand(5, 5, fill))
      .constrain("no_side_slip", row_by_hand(true, 0, 0, 3), when)
      .constrain("left_wheel", row_by_hand(false, -b, r, 3), when)
      .constrain("right_wheel", row_by_hand(false, b, r, 4), when);
}

class Carriage {
 public:
  Carriage(const Values& p, Initial initial)
      : m_(p["m"]),
        I_(p["I"]),
        I_w_(p["I_w"]),
        a_(p["a"]),
        b_(p["b"]),
        r_(p["r"]),
        start_(std::move(initial)) {
    const double largest = m_ * r_ * r_ / 2;  // both wheels together are lighter than m
    if (I_w_ > largest) refuse("I_w", I_w_, "at most m r^2/2 = " + shortest(largest));
  }

  Known free(double t) const {
    const Vector &q = start_.q, &v = start_.v;
    const double half = v[2] * t / 2, chord = 2 * a_ * std::sin(half), theta = q[2] + v[2] * t;
    const double V_x = v[0] - a_ * v[2] * std::sin(q[2]), V_y = v[1] + a_ * v[2] * std::cos(q[2]);
    return {vector({q[0] + V_x * t + chord * std::sin(q[2] + half),
                    q[1] + V_y * t - chord * std::cos(q[2] + half), theta, q[3] + v[3] * t, q[4] + v[4] * t}),
            vector({V_x + a_ * v[2] * std::sin(theta), V_y - a_ * v[2] * std::cos(theta), v[2], v[3], v[4]}),
            Vector::Zero(3)};
  }

  std::optional<Known> held(const Known& before, double time) const {
    const double theta1 = before.q[2];
    const auto [u1, w1] = after_impulse(before);
    const double scale = std::sqrt(inertia() / mass());  // of w against u
    const double c = std::hypot(u1, scale * w1), rate = m_ * a_ / inertia() * c;
    const auto relaxed = [=, u1 = u1, w1 = w1](double t) {
      return Relaxation::from(u1, scale * w1, rate, t);
    };
    const auto angle = [=](const Relaxation& then) { return theta1 + c / scale * then.sine_integral; };
    const auto velocity = [&](double t) {
      const Relaxation then = relaxed(t);
      return c * then.cosine * std::polar(1.0, angle(then));
    };
    const auto way = path(velocity, time, 1 / std::max(std::abs(rate) / 2, c / scale / 4));
    if (!way) return std::nullopt;
    const Relaxation now = relaxed(time);
    const double u = c * now.cosine, w = c / scale * now.sine, theta = angle(now);
    const double forward = c * now.cosine_integral, turned = b_ * (theta - theta1);
    const double ud = m_ * a_ * w * w / mass(), wd = -m_ * a_ * u * w / inertia();
    const double share = -I_w_ / (r_ * r_);
    return Known{vector({before.q[0] + way->real(), before.q[1] + way->imag(), theta,
                         before.q[3] + (forward - turned) / r_, before.q[4] + (forward + turned) / r_}),
                 vector({u * std::cos(theta), u * std::sin(theta), w, (u - b_ * w) / r_, (u + b_ * w) / r_}),
                 vector({m_ * (u * w + a_ * wd), share * (ud - b_ * wd), share * (ud + b_ * wd)})};
  }

  std::vector<Invariant> invariants() const {
    const double squared = inertia() / mass(), b = b_, r = r_;
    const double scale = std::sqrt(squared), a = m_ * a_ / mass();
    const auto along = [](const State& s) { return s.v[0] * std::cos(s.q[2]) + s.v[1] * std::sin(s.q[2]); };
    return {energy(),
            {"a theta + kappa psi",
             [=](const State& s) { return a * s.q[2] + scale * std::atan2(scale * s.v[2], along(s)); }},
            {"2 b theta + r (phi_left - phi_right)",
             [=](const State& s) { return 2 * b * s.q[2] + r * (s.q[3] - s.q[4]); }}};
  }

 private:
  double mass() const { return m_ + 2 * I_w_ / (r_ * r_); }
  double inertia() const { return I_ + m_ * a_ * a_ + 2 * I_w_ * b_ * b_ / (r_ * r_); }

  // u and w; the momenta along the two motions that the wheels allow stay.
  std::pair<double, double> after_impulse(const Known& before) const {
    const Vector& v = before.v;
    const double c = std::cos(before.q[2]), s = std::sin(before.q[2]);
    const double along = v[0] * c + v[1] * s, across = v[1] * c - v[0] * s;
    return {(m_ * along + I_w_ / r_ * (v[4] + v[3])) / mass(),
            ((I_ + m_ * a_ * a_) * v[2] + m_ * a_ * across + I_w_ * b_ / r_ * (v[4] - v[3])) / inertia()};
  }

  double m_, I_, I_w_, a_, b_, r_;
  Initial start_;
};

Example build(const Values& p) {
  Example example{automatic(p), by_hand(p), {}, {}, {}};
  example.initial = initial_state(example.model, p);
  const Carriage carriage(p, example.initial);
  example.known = applied_at(
      p["t_switch"], [carriage](double t) { return carriage.free(t); },
      [carriage](const Known& before, double time) { return carriage.held(before, time); });
  example.invariants = carriage.invariants();
  return example;
}

}  // namespace
}  // namespace chaplygin_carriage_parts

Entry chaplygin_carriage() {
  using namespace chaplygin_carriage_parts;
  return {
      "chaplygin_carriage",
      "a two-wheeled carriage, let down while it glides: three constraints at once",
      description,
      {positive("m", 3, "mass of all [kg]"),
       positive("I", 0.5, "moment of inertia of all about the vertical through the mass centre [kg m^2]"),
       positive("I_w", 0.02, "moment of inertia of a wheel about the axle, at most m r^2/2 [kg m^2]"),
       number("a", 0.3, "how far the mass centre is ahead of the axle [m]"),
       positive("b", 0.4, "how far a wheel is from the middle of the axle [m]"),
       positive("r", 0.2, "radius of the wheels [m]"), switch_time(0.5),
       number("x", 0, "middle of the axle at t = 0 [m]"), number("y", 0, "middle of the axle at t = 0 [m]"),
       number("theta", 0.5, "heading at t = 0 [rad]"), number("phi_left", 0, "turn of the left wheel [rad]"),
       number("phi_right", 0, "turn of the right wheel [rad]"),
       number("x_dot", -0.5, "velocity of the axle [m/s]"), number("y_dot", -1, "velocity of the axle [m/s]"),
       number("theta_dot", 1.5, "rate of the heading [rad/s]"),
       number("phi_left_dot", 3, "rate of the left wheel [rad/s]"),
       number("phi_right_dot", -1, "rate of the right wheel [rad/s]")},
      5,
      0.5,
      build};
}

}  // namespace hybrid_sphere::mechanics::catalogue
