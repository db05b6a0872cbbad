#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hybrid_sphere/mechanics/solve.hpp"
#include "python/collected.hpp"
#include "python/signals.hpp"

namespace hybrid_sphere::python {

/// hybrid_sphere.Model: what is solved, and becomes a plant.
struct PythonModel {
  std::shared_ptr<mechanics::Model> model = std::make_shared<mechanics::Model>();
  KeptFunctions kept;  ///< functions of the model that are written in Python

  // Of the catalogue.
  std::optional<double> duration;             ///< [s]
  std::optional<mechanics::Initial> initial;  ///< none: whoever asks for a motion says where it starts

  bool calls_python() const { return static_cast<bool>(kept.list()); }
  const KeptFunctions& functions() const { return kept; }
  pybind11::object let_go() {
    *model = {};
    return kept.let_go();
  }
};

/// hybrid_sphere.System: of the catalogue, or from functions.
struct PythonSystem : PythonModel {
  // Of the catalogue.
  std::string name;
  std::string title;
  std::string description;
  std::vector<std::pair<std::string, double>> parameters;
};

/// A motion that is asked for.
struct MotionRequest {
  pybind11::object q;  ///< None: that of the catalogue
  pybind11::object v;
  std::optional<double> t;  ///< [s]
  double accuracy = 0;
  bool project = false;
  bool project_positions = false;
  std::optional<double> max_step;  ///< [s]
};

/// Where the motion starts: as the request says, else as a rule. Finds out how many functions the
/// constraints have whose functions are written in Python.
/// @param usual  where the system starts as a rule
/// @param model  of the system, a copy: a function may add to that of the system
/// Throws std::invalid_argument, SceneError, and what these functions throw.
mechanics::Initial start_of(const std::optional<mechanics::Initial>& usual, const mechanics::Model& model,
                            const MotionRequest& request);

/// @param signals  end the motion as cancelled; has to live as long as it
mechanics::Options options_of(const MotionRequest& request, Signals& signals);

/// (size) numbers. Throws SceneError for what is no vector. @param name  "q"
mechanics::Vector vector_of(const pybind11::handle& object, const char* name);

/// While one lives, a motion is computed: without the lock of the interpreter where it calls no Python; else
/// with it, and numpy does not warn of what NotFinite tells.
class WhileComputing {
 public:
  explicit WhileComputing(bool calls_python);
  ~WhileComputing();
  WhileComputing(const WhileComputing&) = delete;
  WhileComputing& operator=(const WhileComputing&) = delete;

 private:
  std::optional<WithoutLock> released_;
  pybind11::object no_warnings_;
};

/// Raises hybrid_sphere.Halted. @param states  None, or those before
[[noreturn]] void raise_halted(const mechanics::Status& status, const pybind11::object& states);

/// Raises it where the equations have no solution, or are not finite, at a time.
[[noreturn]] void raise_halted(const NumericalError& error, double time);

/// hybrid_sphere.Model, hybrid_sphere.System, hybrid_sphere.systems and hybrid_sphere.catalogue
void declare_system(pybind11::module_& module);

}  // namespace hybrid_sphere::python
