#include "random_systems.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <sstream>

#include "chance.hpp"

namespace hybrid_sphere::fuzz {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::integer;

double number(double size) { return integer(-32, 32) / 32.0 * size; }
double positive(double size) { return integer(1, 32) / 32.0 * size; }

Vector3d vector(double size) {
  const double x = number(size);
  const double y = number(size);
  return {x, y, number(size)};
}

Vector3d direction() {
  const Vector3d drawn = vector(1);
  return drawn.norm() > 0 ? Vector3d(drawn.normalized()) : Vector3d::UnitZ();
}

Eigen::Matrix<double, 2, 3> directions_across(const Vector3d& normal) {
  const Vector3d first = normal.unitOrthogonal();
  Eigen::Matrix<double, 2, 3> result;
  result << first.transpose(), normal.cross(first).transpose();
  return result;
}

Matrix3d draw_mass() {
  Matrix3d root;
  for (int i = 0; i < 3; ++i) root.row(i) = vector(0.6);
  return Matrix3d::Identity() + root * root.transpose();
}

RandomSystem::Contact draw_contact(const Vector3d& weight) {
  RandomSystem::Contact contact{};
  contact.normal = chance(3) || weight.norm() == 0 ? direction() : Vector3d(-weight.normalized());
  contact.offset = positive(1);
  contact.wave = chance(3) ? number(0.3) : 0;
  contact.restitution = chance(2) ? 0 : positive(0.95);
  contact.tangents = directions_across(contact.normal);
  contact.slip_components = chance(4) ? 0 : chance(3) ? 1 : 2;
  contact.coefficient = positive(0.6);
  contact.static_coefficient = contact.coefficient * (chance(3) ? 1 + positive(0.5) : 1);
  return contact;
}

RandomSystem::Event draw_event() {
  RandomSystem::Event event{};
  event.normal = direction();
  event.offset = number(0.5);
  event.of_velocities = chance(3);
  const int crossing = integer(0, 2);
  event.crossing = crossing == 0   ? mechanics::Crossing::falling
                   : crossing == 1 ? mechanics::Crossing::rising
                                   : mechanics::Crossing::either;
  if (chance(2)) event.kept = number(1);
  return event;
}

RandomSystem::Constraint draw_constraint() {
  RandomSystem::Constraint constraint{};
  constraint.a = direction();
  constraint.b = direction();
  constraint.turn = chance(2) ? number(2) : 0;
  constraint.begin = positive(1);
  constraint.end = constraint.begin + positive(1);
  if (chance(2)) constraint.guard = direction();
  constraint.guard_offset = -positive(0.5);
  return constraint;
}

template <class T, class Vector>
T along(const Vector3d& normal, const Vector& q) {
  return normal[0] * q[0] + normal[1] * q[1] + normal[2] * q[2];
}

template <class Vector>
auto slip_along(const Eigen::Matrix<double, 2, 3>& directions, const Vector& v) {
  using T = std::decay_t<decltype(v[0] * 1.0)>;
  return Eigen::Matrix<T, 2, 1>(along<T>(directions.row(0).transpose(), v),
                                along<T>(directions.row(1).transpose(), v));
}

void add_contact(const RandomSystem::Contact& contact, const std::string& number, const Units& units,
                 mechanics::System<3>& system) {
  const double length = units.length;
  system.unilateral(
      "contact_" + number,
      [contact, length](const auto&, const auto& q) {
        using std::sin;
        using T = std::decay_t<decltype(q[0] * 1.0)>;
        return T(along<T>(contact.normal, q) + length * contact.offset +
                 length * contact.wave * sin(q[0] / length));
      },
      contact.restitution);
  if (contact.slip_components == 1) {
    system.friction(
        "friction_" + number,
        [contact](const auto&, const auto&, const auto& v) {
          return along<std::decay_t<decltype(v[0] * 1.0)>>(contact.tangents.row(0).transpose(), v);
        },
        contact.coefficient, "contact_" + number, contact.static_coefficient);
  } else if (contact.slip_components == 2) {
    system.friction(
        "friction_" + number,
        [contact](const auto&, const auto&, const auto& v) { return slip_along(contact.tangents, v); },
        contact.coefficient, "contact_" + number, contact.static_coefficient);
  }
}

void add_event(const RandomSystem::Event& event, const std::string& number, const Units& units,
               mechanics::System<3>& system) {
  const double unit = event.of_velocities ? units.length / units.time : units.length;
  const auto g = [event, unit](double, const mechanics::Vector& q, const mechanics::Vector& v) {
    const auto& x = event.of_velocities ? v : q;
    return along<double>(event.normal, x) + unit * event.offset;
  };
  if (!event.kept) {
    system.event("event_" + number, g, event.crossing);
    return;
  }
  system.event("event_" + number, g, event.crossing,
               [kept = *event.kept](double, const mechanics::Vector&, const mechanics::Vector& v) {
                 return mechanics::Vector(kept * v);
               });
}

void add_constraint(const RandomSystem::Constraint& constraint, const Units& units,
                    mechanics::System<3>& system) {
  const double length = units.length;
  const auto f = [constraint, length](const auto&, const auto& q, const auto& v) {
    using std::cos;
    using std::sin;
    using T = std::decay_t<decltype(q[0] * v[0])>;
    const T angle = constraint.turn * q[2] / length;
    return T(cos(angle) * along<T>(constraint.a, v) + sin(angle) * along<T>(constraint.b, v));
  };
  if (!constraint.guard) {
    system.constrain("constraint", f,
                     mechanics::between(constraint.begin * units.time, constraint.end * units.time));
    return;
  }
  system.constrain("constraint", f,
                   mechanics::while_positive([constraint, length](const auto&, const auto& q) {
                     using T = std::decay_t<decltype(q[0] * 1.0)>;
                     return T(along<T>(*constraint.guard, q) + length * constraint.guard_offset);
                   }));
}

}  // namespace

RandomSystem draw_random_system() {
  RandomSystem random{};
  random.mass = draw_mass();
  random.mass_wave = chance(2) ? number(0.3) : 0;
  random.weight = chance(5) ? Vector3d(vector(1)) : Vector3d(10 * direction());
  random.stiffness = chance(2) ? Vector3d(vector(4).cwiseAbs()) : Vector3d(Vector3d::Zero());
  random.damping = chance(4) ? positive(1) : 0;
  random.drive = chance(3) ? vector(8) : Vector3d(Vector3d::Zero());
  random.drive_rate = positive(8);
  for (int i = integer(0, 3); i > 0; --i) random.contacts.push_back(draw_contact(random.weight));
  if (chance(3)) {
    random.friction = {directions_across(direction()), positive(0.6), positive(8)};
  }
  for (int i = integer(0, 2); i > 0; --i) random.events.push_back(draw_event());
  if (chance(3)) random.constraint = draw_constraint();
  random.velocity = chance(4) ? Vector3d(Vector3d::Zero()) : Vector3d(vector(3));
  random.duration = 0.5 + positive(2);
  random.accuracy = std::pow(10.0, -integer(4, 10));
  return random;
}

mechanics::System<3> system_of(const RandomSystem& random, const Units& units) {
  const double energy = units.energy();
  const double length = units.length;
  const double time = units.time;
  const auto lagrangian = [&random, energy, length, time](const auto&, const auto& q, const auto& v) {
    using std::cos;
    using T = std::decay_t<decltype(q[0] * v[0])>;
    T kinetic(0.0);
    T potential(0.0);
    for (int i = 0; i < 3; ++i) {
      T row(0.0);
      for (int j = 0; j < 3; ++j) row += random.mass(i, j) * (v[j] * (time / length));
      kinetic += (v[i] * (time / length)) * row / 2;
      const T place = T(q[i] / length);
      potential += random.stiffness[i] * place * place / 2 - random.weight[i] * place;
    }
    return T(energy * ((1 + random.mass_wave * cos(q[1] / length)) * kinetic - potential));
  };
  const auto forces = [&random, c = random.damping * units.mass / time, force = energy / length, time](
                          const auto& t, const auto&, const auto& v) {
    using std::cos;
    auto sum = (-c * v).eval();
    for (int i = 0; i < 3; ++i) {
      sum[i] += force * random.drive[i] * cos(random.drive_rate * (t / time) + i);
    }
    return sum;
  };
  mechanics::System<3> system({"x", "y", "z"}, lagrangian, forces);
  for (std::size_t i = 0; i < random.contacts.size(); ++i) {
    add_contact(random.contacts[i], std::to_string(i), units, system);
  }
  if (random.friction) {
    const RandomSystem::LoadedFriction& friction = *random.friction;
    system.friction(
        "brake",
        [friction](const auto&, const auto&, const auto& v) { return slip_along(friction.directions, v); },
        friction.coefficient,
        [load = friction.load * energy / length](double, const auto&, const auto&) { return load; });
  }
  for (std::size_t i = 0; i < random.events.size(); ++i) {
    add_event(random.events[i], std::to_string(i), units, system);
  }
  if (random.constraint) add_constraint(*random.constraint, units, system);
  return system;
}

mechanics::Initial start_of(const RandomSystem& random, const Units& units) {
  mechanics::Initial start;
  start.q = Vector3d::Zero();
  start.v = random.velocity * (units.length / units.time);
  return start;
}

bool RandomSystem::keeps_energy_between_switches() const {
  if (damping > 0 || friction || is_driven()) return false;
  for (const Contact& contact : contacts) {
    if (contact.slip_components > 0) return false;
  }
  return true;
}

std::string RandomSystem::text() const {
  std::ostringstream text;
  text.precision(17);
  text << "mass [" << mass << "] wave " << mass_wave << " weight " << weight.transpose() << " stiffness "
       << stiffness.transpose() << " damping " << damping << " drive " << drive.transpose() << " at "
       << drive_rate << '\n';
  for (const Contact& c : contacts) {
    text << "contact normal " << c.normal.transpose() << " offset " << c.offset << " wave " << c.wave << " e "
         << c.restitution << " components " << c.slip_components << " mu " << c.coefficient << " static "
         << c.static_coefficient << '\n';
  }
  if (friction) text << "brake mu " << friction->coefficient << " load " << friction->load << '\n';
  for (const Event& e : events) {
    text << "event normal " << e.normal.transpose() << " offset " << e.offset << " of velocities "
         << e.of_velocities << " crossing " << static_cast<int>(e.crossing) << " keeps "
         << (e.kept ? std::to_string(*e.kept) : "all") << '\n';
  }
  if (constraint) {
    text << "constraint a " << constraint->a.transpose() << " b " << constraint->b.transpose() << " turn "
         << constraint->turn << " from " << constraint->begin << " to " << constraint->end << " guard "
         << constraint->guard.has_value() << ' ' << constraint->guard_offset << '\n';
  }
  text << "velocity " << velocity.transpose() << " duration " << duration << " accuracy " << accuracy;
  return text.str();
}

}  // namespace hybrid_sphere::fuzz
