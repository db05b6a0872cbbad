#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <optional>

#include "hybrid_sphere/mechanics/plant.hpp"
#include "python/collected.hpp"

namespace hybrid_sphere::python {

/// The system of Plant and of linearize with its first input: a hybrid_sphere.Model, whose input are
/// generalised forces, or a function model(u) of Python, which returns the Model for an input. All of it
/// needs the lock of the interpreter, also to be destroyed.
class PythonModelOfInput {
 public:
  /// @param input  None, False: none; True: generalised forces, 0 at first; else numbers
  /// Throws TypeError if the system is neither, or if the function returns no Model; std::invalid_argument
  /// for generalised forces of another number, and for a function without an input; SceneError for an input
  /// that is no vector; and what the function raises.
  PythonModelOfInput(const pybind11::object& system, const pybind11::object& input);

  /// For the first input. The sizes of its constraints may be unknown (find_sizes()).
  const mechanics::Model& model() const { return model_; }
  const std::optional<mechanics::Initial>& initial() const { return initial_; }  ///< of the catalogue
  bool has_input() const { return input_.has_value(); }
  const mechanics::Vector& input() const { return *input_; }  ///< the first one
  /// Two systems are the same if these are equal.
  const std::shared_ptr<const void>& origin() const { return origin_; }

  /// Its models have constraints of the sizes of model(), which have to be known by now. It calls Python with
  /// the lock, and lives no longer than this.
  mechanics::ModelOfInput function() const;

  /// Those that the present model calls, and the function that makes it.
  const KeptFunctions& functions() const { return kept_; }
  void set_functions(const KeptFunctions& functions) { kept_ = functions; }
  /// The model that function() has made last is the present one from now on, or is not used: the one before
  /// is the present one.
  void accept_last();
  void drop_last();
  pybind11::object let_go() { return kept_.let_go(); }

 private:
  class Maker;

  mechanics::Model model_;
  std::optional<mechanics::Initial> initial_;
  std::optional<mechanics::Vector> input_;
  std::shared_ptr<const void> origin_;
  KeptFunctions kept_;
  std::shared_ptr<Maker> maker_;  // null: the system is a Model
};

}  // namespace hybrid_sphere::python
