#include "sphere/contact_mode.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "integration/bracketed_root.hpp"

namespace hybrid_sphere {
namespace {

Vector2d unit(const Vector2d& w) {
  const double length = stable_norm(w);
  return length > 0 ? Vector2d(w / length) : Vector2d(Vector2d::Zero());
}

/// The longest part of a vector that is no longer than a limit.
Vector2d clipped(const Vector2d& w, double limit) {
  const double length = stable_norm(w);
  return length <= limit ? w : Vector2d(limit / length * w);
}

/// The response at one instant. In the unit m = 1, with q = (1 - kappa)/kappa and G = g/q:
/// s' = drive + lambda - nu', nu' = q (G - lambda - c).
class Decision {
 public:
  Decision(const ContactForces& forces, const Vector2d& slip, const Vector2d& nu)
      : forces_(forces),
        slip_(slip),
        nu_(nu),
        q_((1 - forces.kappa) / forces.kappa),
        share_(forces.kappa / (1 - forces.kappa) * forces.spin),
        size_(forces.drive_size + share_.norm()) {}

  ContactResponse response() const {
    // Without friction a slip of 0 is nothing special.
    if (!slip_.isZero(0) || forces_.friction == 0) return sliding_on();
    if (!nu_.isZero(0)) return rolling_on();
    return from_rest();
  }

 private:
  /// What rounding cannot tell from the limit is within it. The searches for the end of a mode allow twice as
  /// much.
  static bool within(const Vector2d& force, double limit, double size) {
    return force.norm() <= limit + 4 * DBL_EPSILON * (size + limit);
  }
  bool grips(const Vector2d& reaction, double couple) const {
    return forces_.friction == never ||
           within(reaction, forces_.friction, size_ + (1 - forces_.kappa) * couple);
  }
  bool resists(const Vector2d& couple) const {
    return forces_.resistance > 0 && within(couple, forces_.resistance, size_);
  }

  ContactResponse answer(ContactMode mode, const Vector2d& reaction, const Vector2d& couple) const {
    ContactResponse out;
    out.mode = mode;
    out.reaction = reaction;
    out.couple = couple;
    if (mode == ContactMode::rolling) out.roll_rate = forces_.drive + reaction;
    if (mode == ContactMode::sliding) out.roll_rate = forces_.spin - q_ * (reaction + couple);
    if (mode == ContactMode::sliding || mode == ContactMode::skidding) {
      out.slip_rate = forces_.drive + reaction - out.roll_rate;
    }
    return out;
  }

  ContactResponse sliding_on() const {
    const Vector2d reaction = -forces_.friction * unit(slip_);
    if (!nu_.isZero(0)) return answer(ContactMode::sliding, reaction, forces_.resistance * unit(nu_));
    const Vector2d held = share_ - reaction;
    const bool skids = resists(held);
    return answer(skids ? ContactMode::skidding : ContactMode::sliding, reaction,
                  skids ? held : clipped(held, forces_.resistance));
  }

  /// lambda of rolling against a couple: kappa (g - f + u') - (1 - kappa) c.
  Vector2d rolling_reaction(const Vector2d& couple) const {
    return forces_.kappa * (forces_.spin - forces_.drive) - (1 - forces_.kappa) * couple;
  }

  ContactResponse rolling_on() const {
    const Vector2d couple = forces_.resistance * unit(nu_);
    const Vector2d reaction = rolling_reaction(couple);
    const bool rolls = grips(reaction, forces_.resistance);
    return answer(rolls ? ContactMode::rolling : ContactMode::sliding,
                  rolls ? reaction : clipped(reaction, forces_.friction), couple);
  }

  ContactResponse from_rest() const {
    const Vector2d holding = -forces_.drive;
    const Vector2d held = share_ - holding;
    const bool is_held = resists(held);
    if (is_held && grips(holding, 0)) return answer(ContactMode::sticking, holding, held);
    const Vector2d couple = clipped(held, forces_.resistance);
    const Vector2d rolling = rolling_reaction(couple);
    if (!is_held && grips(rolling, forces_.resistance)) return answer(ContactMode::rolling, rolling, couple);
    const Vector2d skidding = clipped(holding, forces_.friction);
    if (resists(share_ - skidding)) return answer(ContactMode::skidding, skidding, share_ - skidding);
    const Vector2d least = least_reaction();
    return answer(ContactMode::sliding, least, clipped(share_ - least, forces_.resistance));
  }

  /// s' under a reaction, and the couple that leaves the least acceleration beside it: half the gradient of
  /// the squared norm by lambda.
  Vector2d slip_rate(const Vector2d& reaction) const {
    const Vector2d rest = share_ - reaction;
    return forces_.drive + reaction - q_ * (rest - clipped(rest, forces_.resistance));
  }
  double squared_norm(const Vector2d& reaction) const {
    const Vector2d rest = share_ - reaction;
    return (forces_.drive + reaction).squaredNorm() +
           q_ * (rest - clipped(rest, forces_.resistance)).squaredNorm();
  }
  Vector2d reaction_at(double angle) const {
    return forces_.friction * Vector2d(std::cos(angle), std::sin(angle));
  }

  /// Where both start: the squared norm is a convex function of lambda, and its least value in the disc lies
  /// on the circle abs(lambda) = mu N. The basin is looked for, then the stationary point in it is bracketed.
  Vector2d least_reaction() const {
    constexpr int places = 96;
    constexpr int halvings = 60;
    if (forces_.friction == 0) return Vector2d::Zero();
    const Vector2d along = unit(forces_.drive.isZero(0) ? share_ : forces_.drive);
    if (std::abs(turned(along).dot(share_)) <= 4 * DBL_EPSILON * share_.norm()) {
      const Vector2d forward = forces_.friction * along;  // all forces along one line
      return slip_rate(forward).dot(forward) < 0 ? forward : Vector2d(-forward);
    }
    const double part = 2 * M_PI / places;
    int best = 0;
    for (int i = 1; i < places; ++i) {
      if (squared_norm(reaction_at(i * part)) < squared_norm(reaction_at(best * part))) best = i;
    }
    const auto is_before = [&](double angle) {
      const Vector2d reaction = reaction_at(angle);
      return slip_rate(reaction).dot(turned(reaction)) < 0;
    };
    const auto [low, high] = integration::halved({(best - 1) * part, (best + 1) * part}, halvings, is_before);
    return reaction_at(0.5 * (low + high));
  }

  const ContactForces& forces_;
  const Vector2d& slip_;
  const Vector2d& nu_;
  double q_;
  Vector2d share_;  // kappa/(1 - kappa) g: the couple that holds nu at 0 where there is no friction
  double size_;
};

}  // namespace

ContactForces::ContactForces(const Dynamics& dynamics, const scene::Material& material,
                             const Vector2d& position, const Vector2d& velocity, const Vector2d& nu)
    : spin(dynamics.spin_acceleration(nu)),
      kappa(dynamics.kappa),
      friction(material.law == scene::Law::coulomb ? material.friction * dynamics.normal_force / dynamics.mass
                                                   : never),
      resistance(material.rolling_resistance * dynamics.normal_force / dynamics.mass) {
  const Vector2d force = dynamics.acceleration(position, velocity);
  const Vector2d of_ground = material.turntable_rate * turned(velocity);  // u'
  drive = force - of_ground;
  drive_size = force.norm() + of_ground.norm();
}

ContactResponse contact_response(const ContactForces& forces, const Vector2d& slip, const Vector2d& nu) {
  return Decision(forces, slip, nu).response();
}

}  // namespace hybrid_sphere
