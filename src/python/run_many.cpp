#include "python/run_many.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <string>
#include <thread>
#include <vector>

#include "python/batch.hpp"
#include "python/errors.hpp"
#include "python/record_dtype.hpp"
#include "python/signals.hpp"
#include "python/times.hpp"
#include "scene/printable.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;
using Numbers = py::array_t<double, py::array::forcecast>;

/// What run_many returns.
struct Runs {
  py::array states;
  py::object switches;
  py::dict halts;
};

/// The values of each path, one list after another, as the samples of one run after another.
void read_samples(const py::object& samples, BatchRequest& request) {
  std::vector<Numbers> columns;
  const auto add = [&](const std::string& path, const py::object& values) {
    const auto column = Numbers::ensure(values);
    if (!column) PyErr_Clear();
    const std::string where = "samples[" + scene::printable(path) + "]";
    if (!column || column.ndim() != 1)
      throw scene::SceneError(where, "not a list of numbers", "one for each run");
    const auto size = static_cast<std::size_t>(column.shape(0));
    if (!columns.empty() && size != request.runs) {
      throw scene::SceneError(where, std::to_string(size) + " numbers",
                              std::to_string(request.runs) + ", as the first one");
    }
    request.runs = size;
    request.paths.push_back(path);
    columns.push_back(column);
  };
  if (py::isinstance<py::array>(samples) && !samples.attr("dtype").attr("names").is_none()) {
    for (const py::handle name : samples.attr("dtype").attr("names")) {
      add(name.cast<std::string>(), samples[name]);
    }
  } else if (py::isinstance<py::dict>(samples)) {
    for (const auto& [name, values] : samples.cast<py::dict>()) {
      if (!py::isinstance<py::str>(name))
        throw scene::SceneError("samples", "a key that is no text", "paths of numbers of a scene");
      add(name.cast<std::string>(), py::reinterpret_borrow<py::object>(values));
    }
  } else {
    throw scene::SceneError("samples", "neither of them", "a dict, or an array with fields");
  }
  if (columns.empty()) throw scene::SceneError("samples", "no path", "one or more");
  request.samples.resize(request.runs * columns.size());
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto values = columns[k].unchecked<1>();
    for (std::size_t i = 0; i < request.runs; ++i) {
      request.samples[i * columns.size() + k] = values(static_cast<py::ssize_t>(i));
    }
  }
}

void read_scenes(const py::object& scenes, BatchRequest& request) {
  if (!py::isinstance<py::list>(scenes) && !py::isinstance<py::tuple>(scenes)) {
    request.scenes.push_back(scene_of(source_of(scenes)));
  } else {
    for (const py::handle scene : scenes) {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      request.scenes.push_back(scene_of(source_of(scene)));
    }
  }
  request.runs = request.scenes.size();
}

std::size_t region_width(const BatchRequest& request) {
  if (!request.paths.empty()) return longest_region_name(scene_of(request.scene).surface);
  std::size_t longest = 1;
  for (const scene::Scene& scene : request.scenes)
    longest = std::max(longest, longest_region_name(scene.surface));
  return longest;
}

std::size_t threads_of(const py::object& threads) {
  if (threads.is_none()) return std::max(1U, std::thread::hardware_concurrency());
  constexpr int most = 1024;
  const int count = threads.cast<int>();
  if (count < 1 || count > most) {
    throw scene::SceneError("threads", std::to_string(count), "1 to " + std::to_string(most) + ", or None");
  }
  return static_cast<std::size_t>(count);
}

Runs run_many(const py::object& scenes, const Numbers& times, const py::object& samples,
              const std::vector<std::string>& fields, bool switches, const py::object& threads) {
  BatchRequest request;
  request.times = times_of(times, 0);
  request.keep_switches = switches;
  request.threads = threads_of(threads);
  if (samples.is_none()) {
    read_scenes(scenes, request);
  } else {
    request.scene = source_of(scenes);
    read_samples(samples, request);
  }
  const StateLayout layout(fields, region_width(request));
  Runs runs;
  runs.states = unset_array(layout.dtype(), {request.runs, request.times.size()});
  Batch batch(request, layout, static_cast<char*>(runs.states.mutable_data()));
  Signals signals;
  try {
    const py::gil_scoped_release unlocked;
    batch.compute([&signals] { return signals.have_come(); });
  } catch (const Interrupted&) {
    signals.rethrow();
  }
  runs.switches = switches ? py::object(batch.take_switches().array(true)) : py::none();
  for (const BatchHalt& halt : batch.halts()) {
    runs.halts[py::int_(halt.run)] = halted(halt.error, py::none());
  }
  return runs;
}

constexpr const char* doc = R"(Computes many runs from time 0, with the lock of the interpreter released.

scenes    a list of scenes, each as Simulation takes them; or one scene, for all samples
times     (m,) ascending [s]
samples   other numbers for each run: a dict {path: (n,)} or an array (n,) with fields; a path is that of a study,
          such as "initial_state.velocity[0]" or "surface.regions[ice].friction"
fields    those of the states that are wanted, such as ["x", "y", "region"]; without qx, qy, qz and qw no
          orientation is computed; empty: all
switches  True: the switches of all runs are kept
threads   None: one for each processor

Returns Runs. The numbers do not depend on the number of threads; run i is that of Simulation, to the bit.

Raises SceneError, of the first run that is refused.)";

}  // namespace

void declare_run_many(py::module_& module) {
  py::class_<Runs>(module, "Runs", "What run_many() returns.")
      .def_readonly(
          "states", &Runs::states,
          "(n, m): the states of run i at times[j], as of Simulation.run(). After a halt those in which it "
          "stays,\nwhose t is less than the time asked for.")
      .def_readonly(
          "switches", &Runs::switches,
          "The switches of all runs in order, as of Simulation.switches, with the field run; None where they "
          "are not kept.")
      .def_readonly("halts", &Runs::halts, "Halted by run, of those that could not be computed to the end.");
  module.def("run_many", &run_many, doc, py::arg("scenes"), py::arg("times"), py::arg("samples") = py::none(),
             py::kw_only(), py::arg("fields") = std::vector<std::string>(), py::arg("switches") = false,
             py::arg("threads") = 1);
}

}  // namespace hybrid_sphere::python
