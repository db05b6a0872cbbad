#include <pybind11/pybind11.h>

#include "python/errors.hpp"
#include "python/linearize.hpp"
#include "python/modes.hpp"
#include "python/multibody.hpp"
#include "python/number_object.hpp"
#include "python/page.hpp"
#include "python/plant.hpp"
#include "python/run_many.hpp"
#include "python/simulation.hpp"
#include "python/solution.hpp"
#include "python/system.hpp"

PYBIND11_MODULE(_core, module) {
  using namespace hybrid_sphere::python;
  module.attr("__version__") = HYBRID_SPHERE_VERSION;
  register_exceptions();
  declare_simulation(module);
  declare_run_many(module);
  declare_page(module);
  declare_number(module);
  declare_solution(module);
  declare_system(module);
  declare_multibody(module);
  declare_plant(module);
  declare_linearize(module);
  declare_modes(module);
}
