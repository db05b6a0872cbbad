#include "python/simulation.hpp"

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "python/errors.hpp"
#include "python/exclusive_use.hpp"
#include "python/kept_switches.hpp"
#include "python/numbers_of.hpp"
#include "python/record_dtype.hpp"
#include "python/scene_of.hpp"
#include "python/signals.hpp"
#include "python/state_layout.hpp"
#include "python/times.hpp"
#include "python/tree_of.hpp"
#include "scene/check.hpp"
#include "scene/ranges.hpp"
#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;

/// A simulation with its switches so far. What takes long releases the lock of the interpreter.
class PythonSimulation {
 public:
  PythonSimulation(const py::object& scene, bool orientation)
      : PythonSimulation(scene_of(source_of(scene)), orientation) {}

  std::uint64_t advance(double time) {
    const ExclusiveUse use(in_use_);
    require(time, {simulation_.time(), Simulation::max_time, "[s]", 0}, "time");
    const std::uint64_t before = simulation_.switches();
    compute([&] { simulation_.advance_to(time, keep_); });
    return simulation_.switches() - before;
  }

  py::array run(const py::object& times) {
    const ExclusiveUse use(in_use_);
    const std::vector<double> all = times_of(times, simulation_.time());
    StateLayout& layout = this->layout();
    py::array states = unset_array(dtype_, {all.size()});
    auto* const items = static_cast<char*>(states.mutable_data());
    std::size_t done = 0;
    try {
      compute([&] {
        for (const double time : all) {
          simulation_.advance_to(time, keep_);
          layout.put(simulation_.state(), items + done++ * layout.item_size());
        }
      });
    } catch (const HaltedError& error) {
      if (error.stop() == Stop::out_of_memory) throw;
      const py::object halt = halted(error, states[py::slice(0, static_cast<py::ssize_t>(done), 1)]);
      PyErr_SetObject(py::type::of(halt).ptr(), halt.ptr());
      throw py::error_already_set();
    }
    return states;
  }

  py::object state() {
    const ExclusiveUse use(in_use_);
    StateLayout& layout = this->layout();
    py::array states = unset_array(dtype_, {1});
    layout.put(simulation_.state(), static_cast<char*>(states.mutable_data()));
    return states[py::int_(0)];
  }

  py::array switches() {
    const ExclusiveUse use(in_use_);
    layout();
    return switches_.array(false, region_width_);
  }

  double time() {
    const ExclusiveUse use(in_use_);
    return simulation_.time();
  }
  Vector2d slip() {
    const ExclusiveUse use(in_use_);
    return simulation_.state().slip;
  }
  Vector3d reaction() {
    const ExclusiveUse use(in_use_);
    return simulation_.reaction();
  }
  double energy() {
    const ExclusiveUse use(in_use_);
    return simulation_.sphere().kinetic_energy(simulation_.state().twist);
  }
  double estimated_error() {
    const ExclusiveUse use(in_use_);
    return simulation_.estimated_error();
  }
  std::uint64_t evaluations() {
    const ExclusiveUse use(in_use_);
    return simulation_.evaluations();
  }

  void command(const py::object& force, const py::object& torque) {
    const ExclusiveUse use(in_use_);
    const scene::Tree wrench(scene::Tree::Map{{"force", tree_of(force, "command.force")},
                                              {"torque", tree_of(torque, "command.torque")}});
    simulation_.set_command(scene::read_wrench(wrench, scene_.sphere, "command"));
  }

  void kick(const py::object& impulse) {
    const ExclusiveUse use(in_use_);
    const Numbers numbers = numbers_of(impulse, "impulse");
    if (numbers.ndim() != 1 || numbers.size() != 2) {
      throw scene::SceneError("impulse", "not a list of two numbers", "(x, y) [N s]");
    }
    try {
      simulation_.kick({numbers.at(0), numbers.at(1)});
    } catch (const std::invalid_argument&) {
      throw scene::SceneError(
          "impulse", "(" + text::shortest(numbers.at(0)) + ", " + text::shortest(numbers.at(1)) + ")",
          "(x, y) [N s] that change the velocity by at most 1e+15 m/s");
    }
  }

  void set_surface(const py::object& surface) {
    const ExclusiveUse use(in_use_);
    scene::Tree tree = tree_of(surface, "surface");
    scene::Surface read;
    compute([&] {
      if (const auto text = tree.as_text()) tree = scene::tree_from_yaml(std::string(*text));
      read = scene::read_surface(tree);
      scene::check_pressure(read, scene_.forces, "surface");
      simulation_.set_surface(read);
    });
    // Until the new ground acts, the state has the name of the one before.
    region_width_ = std::max({region_width_, longest_region_name(scene_.surface), longest_region_name(read)});
    scene_.surface = read;
    layout_.reset();
  }

  void set_state(const py::object& state) {
    const ExclusiveUse use(in_use_);
    simulation_.set_state(scene::read_initial_state(tree_of(state, "state"), "state"));
  }

  void reset(const py::object& initial_state) {
    const ExclusiveUse use(in_use_);
    if (initial_state.is_none()) {
      simulation_.reset();
    } else {
      simulation_.set_initial_state(
          scene::read_initial_state(tree_of(initial_state, "initial_state"), "initial_state"));
    }
    switches_.clear();
  }

  double accuracy() const { return scene_.solver.accuracy; }
  void set_accuracy(double accuracy) {
    const ExclusiveUse use(in_use_);
    require(accuracy, scene::accuracy_range, "accuracy");
    simulation_.set_accuracy(accuracy);
    scene_.solver.accuracy = accuracy;
  }

  std::string describe() {
    if (in_use_.is_taken()) return "<hybrid_sphere.Simulation, computing>";
    const std::uint64_t count = simulation_.switches();
    return "<hybrid_sphere.Simulation at t = " + text::shortest(simulation_.time()) + " s, " +
           std::to_string(count) + (count == 1 ? " switch>" : " switches>");
  }

 private:
  PythonSimulation(scene::Scene scene, bool orientation) : scene_(std::move(scene)), simulation_(scene_) {
    simulation_.set_interrupt([this] { return signals_.have_come(); });
    if (!orientation) simulation_.follow_orientation(false);
  }

  static void require(double number, const scene::Range& range, const char* key) {
    if (!range.holds(number)) throw scene::SceneError(key, text::shortest(number), range.describe());
  }

  /// Without the lock; throws what a signal's handler has thrown.
  template <class Function>
  void compute(Function function) {
    try {
      const WithoutLock unlocked;
      function();
    } catch (const Interrupted&) {
      signals_.rethrow();
    }
  }

  /// Made where it is needed first: a map may have 100,000 names.
  StateLayout& layout() {
    if (!layout_) {
      region_width_ = std::max(region_width_, longest_region_name(scene_.surface));
      layout_.emplace(std::vector<std::string>(), region_width_);
      dtype_ = layout_->dtype();
    }
    return *layout_;
  }

  scene::Scene scene_;
  Simulation simulation_;
  KeptSwitches switches_;
  const Simulation::SwitchSink keep_ = [this](const Switch& event) { switches_.add(event); };
  std::size_t region_width_ = 1;  // characters of the longest name of a region so far
  std::optional<StateLayout> layout_;
  py::dtype dtype_{"f8"};  // of that
  Signals signals_;
  InUse in_use_;
};

constexpr const char* simulation_doc = R"(A simulation of one scene, advanced in time.

scene        the name of a scene file; a scene as text (YAML: it begins with { or has more than one line); or a dict
orientation  False: the orientation stays that of the initial state, which saves its computation; all else is the
             same to the bit

Numbers are SI units in the world frame, as in docs/scene_files.md. They are those of the program simulate, to the bit,
however the time is divided among calls.

Raises SceneError.)";

constexpr const char* advance_doc = R"(Advances to a time [s], not before the present one.

Returns the number of switches on the way, which are appended to `switches`.

Raises SceneError for another time, Halted.)";

constexpr const char* run_doc = R"(Advances to each of some times.

times  (n,) ascending, from the present one [s]

Returns the states there: a structured array (n,) whose fields are the columns of the states that simulate writes: t x y
qx qy qz qw vx vy wx wy wz stage mode region.

Raises SceneError for other times, Halted with the states before the halt.)";

constexpr const char* state_doc =
    R"(The present state, as an item of what run() returns; its fields are attributes, too.

Before the first advance, and after set_state and set_surface, the ground there has not acted yet: run([time]) is the
state after that.)";

constexpr const char* switches_doc = R"(All switches since the initial state.

A structured array whose fields are the columns of the switches that simulate writes, and cause.)";

constexpr const char* command_doc =
    R"(A wrench on the sphere besides that of the scene, until the next command.

force   (2,) on the centre [N]
torque  (3,) [N m]

Raises SceneError.)";

constexpr const char* kick_doc =
    R"(Strikes the centre with an impulse (2,) [N s]; the ground answers in the next advance().

Raises SceneError.)";

constexpr const char* set_surface_doc = R"(Replaces the ground under the moving sphere.

surface  a dict or a text, as the key `surface` of a scene

Raises SceneError, and ValueError where the method exact has no closed form on it.)";

constexpr const char* set_state_doc = R"(Places the sphere; the time goes on.

state  a dict as the key `initial_state` of a scene

Raises SceneError.)";

constexpr const char* reset_doc =
    R"(Returns to time 0 in the initial state, or in another one; forgets the switches.

initial_state  a dict as the key `initial_state` of a scene; None: the last one

Command, ground and accuracy stay as they are. Raises SceneError.)";

void declare_attributes(py::class_<PythonSimulation>& type) {
  type.def_property_readonly("state", &PythonSimulation::state, state_doc)
      .def_property_readonly("switches", &PythonSimulation::switches, switches_doc)
      .def_property_readonly("time", &PythonSimulation::time, "Time reached since the initial state [s].")
      .def_property_readonly("slip", &PythonSimulation::slip,
                             "Velocity of the contact point relative to the ground: (2,) [m/s].")
      .def_property_readonly("reaction", &PythonSimulation::reaction,
                             "Force of the ground on the sphere: (3,) lambda_1, lambda_2, normal force [N].")
      .def_property_readonly("kinetic_energy", &PythonSimulation::energy, "[J]")
      .def_property_readonly("estimated_error", &PythonSimulation::estimated_error,
                             "Of all integrated steps so far, relative; 0 where all is in closed form.")
      .def_property_readonly("evaluations", &PythonSimulation::evaluations,
                             "Of right-hand sides, so far; 0 where all is in closed form.")
      .def_property("accuracy", &PythonSimulation::accuracy, &PythonSimulation::set_accuracy,
                    "Relative error asked for at every output, 1e-14 to 1; from the present time on.");
}

}  // namespace

void declare_simulation(py::module_& module) {
  py::class_<PythonSimulation> type(module, "Simulation", simulation_doc);
  type.def(py::init<const py::object&, bool>(), py::arg("scene"), py::kw_only(),
           py::arg("orientation") = true)
      .def("__repr__", &PythonSimulation::describe)
      .def("advance", &PythonSimulation::advance, py::arg("time"), advance_doc)
      .def("run", &PythonSimulation::run, py::arg("times"), run_doc)
      .def("command", &PythonSimulation::command, py::arg("force") = py::make_tuple(0.0, 0.0),
           py::arg("torque") = py::make_tuple(0.0, 0.0, 0.0), command_doc)
      .def("kick", &PythonSimulation::kick, py::arg("impulse"), kick_doc)
      .def("set_surface", &PythonSimulation::set_surface, py::arg("surface"), set_surface_doc)
      .def("set_state", &PythonSimulation::set_state, py::arg("state"), set_state_doc)
      .def("reset", &PythonSimulation::reset, py::arg("initial_state") = py::none(), reset_doc);
  declare_attributes(type);
}

}  // namespace hybrid_sphere::python
