#include "python/times.hpp"

#include "hybrid_sphere/scene/scene_error.hpp"
#include "hybrid_sphere/simulation/simulation.hpp"
#include "python/numbers_of.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::python {

std::vector<double> times_of(const pybind11::object& given, double from) {
  const Numbers times = numbers_of(given, "times");
  if (times.ndim() != 1) {
    throw scene::SceneError("times", "an array of " + std::to_string(times.ndim()) + " dimensions",
                            "a list of ascending times [s]");
  }
  const auto values = times.unchecked<1>();
  std::vector<double> result;
  result.reserve(static_cast<std::size_t>(values.shape(0)));
  double last = from;
  for (pybind11::ssize_t i = 0; i < values.shape(0); ++i) {
    const double time = values(i);
    if (!(time >= last && time <= Simulation::max_time)) {
      throw scene::SceneError("times[" + std::to_string(i) + "]", text::shortest(time),
                              "ascending times from " + text::shortest(last) + " to " +
                                  text::shortest(Simulation::max_time) + " [s]");
    }
    result.push_back(last = time);
  }
  return result;
}

}  // namespace hybrid_sphere::python
