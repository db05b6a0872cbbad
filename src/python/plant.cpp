#include "python/plant.hpp"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>
#include <stdexcept>

#include "hybrid_sphere/mechanics/plant.hpp"
#include "python/exclusive_use.hpp"
#include "python/model_of_input.hpp"
#include "python/motion_arrays.hpp"
#include "python/solution.hpp"
#include "python/system.hpp"
#include "python/times.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;
using mechanics::Plant;

struct PythonSnapshot {
  KeptFunctions kept;
  Plant::Snapshot present;
  std::vector<mechanics::Switch> switches;
  std::shared_ptr<const void> origin;  // which system it is of
  bool has_input;

  const KeptFunctions& functions() const { return kept; }
  pybind11::object let_go() {
    present = Plant::Snapshot(nullptr);
    origin.reset();
    return kept.let_go();
  }
};

/// A plant with its switches so far.
class PythonPlant {
 public:
  PythonPlant(PythonModelOfInput system, const MotionRequest& request, double horizon)
      : system_(std::move(system)),
        plant_(plant_of(request, horizon)),
        states_(state_table(plant_.model())),
        switch_rows_(switch_table(plant_.model())) {
    system_.accept_last();
  }

  std::size_t advance(double time, const py::object& on_switch) {
    const ExclusiveUse use(in_use_);
    const std::size_t before = switches_.size();
    const mechanics::SwitchSink keep_and_call = [&](const mechanics::Switch& event) {
      keep_(event);
      call(on_switch);
    };
    const mechanics::Status status =
        compute([&] { return plant_.advance(time, on_switch.is_none() ? keep_ : keep_and_call); });
    go_on_after(status, py::none());
    return switches_.size() - before;
  }

  py::array run(const py::object& times) {
    const ExclusiveUse use(in_use_);
    const std::vector<double> all = times_of(times, plant_.time());
    states_.clear();
    const mechanics::Status status = compute([&] {
      mechanics::Status so_far;
      for (const double time : all) {
        so_far = plant_.advance(time, keep_);
        if (so_far.stop != mechanics::Stop::reached_end) break;
        add(plant_.model(), plant_.state(), states_);
      }
      return so_far;
    });
    if (status.stop != mechanics::Stop::reached_end) go_on_after(status, states_.array());
    return states_.array();
  }

  py::object state() {
    const ExclusiveUse use(in_use_);
    states_.clear();
    compute([&] {
      add(plant_.model(), plant_.state(), states_);
      return mechanics::Status();
    });
    return states_.array()[py::int_(0)];
  }

  py::array switches() {
    const ExclusiveUse use(in_use_);
    switch_rows_.clear();
    for (const mechanics::Switch& event : switches_) add(plant_.model(), event, switch_rows_);
    return switch_rows_.array();
  }

  double time() {
    const ExclusiveUse use(in_use_);
    return plant_.time();
  }
  std::uint64_t steps() {
    const ExclusiveUse use(in_use_);
    return plant_.steps();
  }
  std::uint64_t evaluations() {
    const ExclusiveUse use(in_use_);
    return plant_.evaluations();
  }

  py::tuple projection() {
    const ExclusiveUse use(in_use_);
    return pair_of(plant_.projection());
  }

  py::object input() {
    const ExclusiveUse use(in_use_);
    if (!system_.has_input()) return py::none();
    const Eigen::VectorXd copy = plant_.input();
    return py::cast(copy);
  }
  void set_input(const py::object& input) {
    const ExclusiveUse use(in_use_);
    try {
      plant_.set_input(vector_of(input, "input"));
    } catch (...) {
      system_.drop_last();
      throw;
    }
    system_.accept_last();
  }

  PythonSnapshot save() {
    const ExclusiveUse use(in_use_);
    return {system_.functions(), plant_.save(), switches_, system_.origin(), system_.has_input()};
  }
  void restore(const PythonSnapshot& snapshot) {
    const ExclusiveUse use(in_use_);
    if (snapshot.origin != system_.origin() || snapshot.has_input != system_.has_input()) {
      throw std::invalid_argument("this is a snapshot of a plant of another system, or with another input");
    }
    plant_.restore(snapshot.present);
    system_.set_functions(snapshot.kept);
    switches_ = snapshot.switches;
  }

  const KeptFunctions& functions() const { return system_.functions(); }
  py::object let_go() {
    if (functions().list()) in_use_.take();
    return system_.let_go();
  }

  std::string describe() {
    if (in_use_.is_taken()) return "<hybrid_sphere.Plant, computing>";
    const std::size_t count = switches_.size();
    return "<hybrid_sphere.Plant at t = " + text::shortest(plant_.time()) + " s, " + std::to_string(count) +
           (count == 1 ? " switch>" : " switches>");
  }

 private:
  Plant plant_of(const MotionRequest& request, double horizon) {
    const mechanics::Initial initial = start_of(system_.initial(), system_.model(), request);
    const mechanics::Options options = options_of(request, signals_);
    if (!system_.has_input()) return {system_.model(), initial, options, horizon};
    return {system_.function(), system_.input(), initial, options, horizon};
  }

  /// Calls a function of the user with the last switch, during which it may use the plant.
  void call(const py::object& on_switch) {
    const py::gil_scoped_acquire lock;
    switch_rows_.clear();
    add(plant_.model(), switches_.back(), switch_rows_);
    const py::object last = switch_rows_.array()[py::int_(0)];
    in_use_.release();
    try {
      on_switch(last);
    } catch (...) {
      in_use_.take();
      throw;
    }
    in_use_.take();
  }

  template <class Function>
  mechanics::Status compute(Function function) {
    try {
      const WhileComputing computing(static_cast<bool>(functions().list()));
      return function();
    } catch (const NumericalError& error) {
      raise_halted(error, plant_.time());
    }
  }

  void go_on_after(const mechanics::Status& status, const py::object& states) {
    if (status.stop == mechanics::Stop::cancelled) signals_.rethrow();
    if (status.stop != mechanics::Stop::reached_end) raise_halted(status, states);
  }

  PythonModelOfInput system_;
  Signals signals_;
  Plant plant_;
  std::vector<mechanics::Switch> switches_;
  const mechanics::SwitchSink keep_ = [this](const mechanics::Switch& event) { switches_.push_back(event); };
  MotionTable states_;
  MotionTable switch_rows_;
  InUse in_use_;
};

constexpr const char* plant_doc = R"(A system that is advanced in time, for controllers.

system    a Model, or a function of the input that returns one: what it makes of the input, in L, Q, f, g, parameters
          or bodies, acts from set_input() on. Names and sizes have to be the same for all inputs, and each call has to
          return a Model of its own.
q, v, t   where and when it starts, as of System.solve
accuracy  as of System.solve, over the horizon
project   as of System.solve
project_positions  as of System.solve
max_step  as of System.solve
horizon   time over which errors may add up to the accuracy, > 0 [s]
input     of a Model: True, set_input() sets generalised forces, 0 at first, or numbers, these at first, (n,); of a
          function: the first input, (m,)

How far it is advanced at a time makes no difference to the motion, to the bit. Ctrl-C ends a long computation; the
plant is then where it came to, and goes on from there. It is one thread's at a time.

Raises ValueError for numbers that are refused, and whatever a function of the system raises.)";

void declare_methods(py::class_<PythonPlant>& type) {
  type.def("__repr__", &PythonPlant::describe)
      .def("advance", &PythonPlant::advance, py::arg("time"), py::arg("on_switch") = py::none(),
           R"(Advances to a time [s], not before the present one.

on_switch  called with each switch, an item of `switches`, when its time is reached. The plant is then at the
           switch: time, state, save() and set_input() may be used, and an input acts from there on.

Returns the number of switches on the way, which are appended to `switches`.

Raises ValueError for another time; Halted, with reason and time, if the motion ends before; RuntimeError in
on_switch; and whatever on_switch raises: the plant then stays at the switch.)")
      .def("run", &PythonPlant::run, py::arg("times"),
           "Advances to each of some times.\n\ntimes  (n,) ascending, from the present one [s]\n\nReturns "
           "the states "
           "there, an array as that of Solution.at.\n\nRaises SceneError for other times; Halted with the "
           "states "
           "before the halt.")
      .def("set_input", &PythonPlant::set_input, py::arg("u"),
           "The input from now on until the next one: generalised forces on the velocities, (n,), besides "
           "those of the\nsystem, or what the function of the input takes, (m,). Velocities that then "
           "violate a constraint begin with a switch.\n\nRaises ValueError for another number of them, for "
           "a plant without input, and for a model of other names or sizes, or\nwhose constraints on "
           "positions do not hold here; nothing has changed then.")
      .def("save", &PythonPlant::save,
           "The present: time, state, which constraints hold, input, switches so far.")
      .def("restore", &PythonPlant::restore, py::arg("snapshot"),
           "Puts it back to a present that save() has returned. From there on it moves as the one that was "
           "saved, "
           "within\nthe accuracy; two that are put back move alike to the bit.\n\nRaises ValueError for a "
           "snapshot of "
           "another system.");
}

void declare_attributes(py::class_<PythonPlant>& type) {
  type.def_property_readonly(
          "state", &PythonPlant::state,
          "The present state, an item of what run() returns: plant.state.x; after a switch there.")
      .def_property_readonly("switches", &PythonPlant::switches,
                             "All switches so far, an array as Solution.switches.")
      .def_property_readonly("time", &PythonPlant::time, "Time reached [s].")
      .def_property_readonly("projection", &PythonPlant::projection, projection_doc)
      .def_property_readonly("input", &PythonPlant::input, "The present input; None without one.")
      .def_property_readonly("steps", &PythonPlant::steps, "Of the integrator, so far.")
      .def_property_readonly("evaluations", &PythonPlant::evaluations, "Of the equations of motion, so far.");
}

}  // namespace

void declare_plant(py::module_& module) {
  const py::class_<PythonSnapshot> snapshot(
      module, "Snapshot", "A plant at one instant: what Plant.save returns.", collected<PythonSnapshot>());
  py::class_<PythonPlant> type(module, "Plant", plant_doc, collected<PythonPlant>());
  type.def(py::init([](const py::object& system, const py::object& q, const py::object& v,
                       const std::optional<double>& t, double accuracy, bool project, bool project_positions,
                       const std::optional<double>& max_step, double horizon, const py::object& input) {
             return std::make_unique<PythonPlant>(
                 PythonModelOfInput(system, input),
                 MotionRequest{q, v, t, accuracy, project, project_positions, max_step}, horizon);
           }),
           py::arg("system"), py::arg("q") = py::none(), py::arg("v") = py::none(), py::kw_only(),
           py::arg("t") = py::none(), py::arg("accuracy") = mechanics::Options().accuracy,
           py::arg("project") = false, py::arg("project_positions") = false, py::arg("max_step") = py::none(),
           py::arg("horizon") = 10.0, py::arg("input") = py::none());
  declare_methods(type);
  declare_attributes(type);
}

}  // namespace hybrid_sphere::python
