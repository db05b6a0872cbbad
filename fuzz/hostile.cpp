#include <cmath>

#include "chance.hpp"
#include "characters.hpp"

namespace hybrid_sphere::fuzz {

using scene::Law;
using testing::integer;

void make_hostile(Case& a_case) {
  scene::Scene& scene = a_case.scene;
  a_case.patient = false;
  const auto number = [] {
    const double power = std::pow(10.0, chance(3) ? integer(-320, 15) : integer(-20, 15));
    return chance(2) ? power : -power;
  };
  const auto component = [&](auto& vector) {
    vector[integer(0, static_cast<int>(vector.size()) - 1)] = number();
  };
  for (int i = integer(1, 3); i > 0; --i) {
    switch (integer(0, 12)) {
      case 0: component(scene.initial_state.velocity); break;
      case 1: component(scene.initial_state.angular_velocity); break;
      case 2: component(scene.initial_state.position); break;
      case 3: component(scene.forces.wrench.torque); break;
      case 4: component(scene.forces.wrench.force); break;
      case 5: scene.forces.drag.translational = std::abs(number()); break;
      case 6: scene.forces.drag.rotational = std::abs(number()); break;
      case 7: scene.forces.drag.quadratic = std::abs(number()); break;
      case 8: scene.forces.spring.stiffness = std::abs(number()); break;
      case 9: scene.surface.base.turntable_rate = scene.surface.base.law == Law::smooth ? 0 : number(); break;
      case 10: component(scene.surface.base.belt); break;
      case 11: component(scene.forces.gravity); break;
      default: {
        const double factor = std::pow(10.0, integer(-12, 12));
        scene.sphere.radius *= factor;
        scene.sphere.gyration_radius *= factor;
      }
    }
  }
  if (chance(4)) a_case.duration = std::pow(10.0, integer(-12, 15));
}

}  // namespace hybrid_sphere::fuzz
