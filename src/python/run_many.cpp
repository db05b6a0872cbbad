#include "python/run_many.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "python/batch.hpp"
#include "python/errors.hpp"
#include "python/numbers_of.hpp"
#include "python/record_dtype.hpp"
#include "python/signals.hpp"
#include "python/times.hpp"
#include "python/tree_of.hpp"
#include "scene/printable.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;

/// What run_many returns.
struct Runs {
  py::array states;
  py::object switches;
  py::dict halts;
};

/// Text as UTF-8. @throws SceneError
std::string text_of(const py::handle& object, const std::string& where) {
  const auto text = tree_of(object, where);
  if (const auto name = text.as_text()) return std::string(*name);
  throw scene::SceneError(where, "a key that is no text", "paths of numbers of a scene");
}

/// The numbers of each path, by path.
std::vector<std::pair<std::string, Numbers>> columns_of(const py::object& samples) {
  py::object columns = samples;
  py::object names = samples;
  if (py::isinstance<py::array>(samples) && !samples.attr("dtype").attr("names").is_none()) {
    names = samples.attr("dtype").attr("names");
  } else if (py::isinstance(samples, py::module_::import("collections.abc").attr("Mapping"))) {
    columns = py::dict(samples);
    names = py::list(columns);
  } else {
    throw scene::SceneError("samples", "an object of another kind", "a dict, or an array with fields");
  }
  std::vector<std::pair<std::string, Numbers>> result;
  for (const py::handle name : names) {
    const std::string path = text_of(name, "samples");
    result.emplace_back(path, numbers_of(columns[name], "samples[" + scene::printable(path) + "]"));
  }
  if (result.empty()) throw scene::SceneError("samples", "no path", "one or more");
  return result;
}

/// The values of each path, one list after another, as the samples of one run after another.
void read_samples(const py::object& samples, BatchRequest& request) {
  const auto columns = columns_of(samples);
  for (const auto& [path, numbers] : columns) {
    const std::string where = "samples[" + scene::printable(path) + "]";
    if (numbers.ndim() != 1) throw scene::SceneError(where, "not a list", "a number for each run");
    const auto size = static_cast<std::size_t>(numbers.shape(0));
    if (request.paths.empty()) request.runs = size;
    if (size != request.runs) {
      throw scene::SceneError(where, std::to_string(size) + " numbers",
                              std::to_string(request.runs) + ", as the first one");
    }
    request.paths.push_back(path);
  }
  request.samples.resize(request.runs * columns.size());
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto values = columns[k].second.unchecked<1>();
    for (std::size_t i = 0; i < request.runs; ++i) {
      request.samples[i * columns.size() + k] = values(static_cast<py::ssize_t>(i));
    }
  }
}

bool is_one_scene(const py::object& scenes) {
  return py::isinstance<py::str>(scenes) ||
         py::isinstance(scenes, py::module_::import("collections.abc").attr("Mapping")) ||
         py::isinstance(scenes, py::module_::import("os").attr("PathLike")) ||
         !py::isinstance<py::iterable>(scenes);
}

void read_scenes(const py::object& scenes, BatchRequest& request) {
  if (is_one_scene(scenes)) {
    request.scenes.push_back(scene_of(source_of(scenes)));
  } else {
    for (const py::handle scene : py::tuple(scenes)) {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      try {
        request.scenes.push_back(scene_of(source_of(scene)));
      } catch (const scene::SceneError& error) {
        const std::string which = "scenes[" + std::to_string(request.scenes.size()) + "]";
        if (error.path().empty()) throw scene::SceneError(which + ": " + error.what());
        throw scene::SceneError(which + "." + error.path(), error.value(), error.allowed());
      }
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

std::size_t threads_of(const std::optional<int>& threads) {
  if (!threads) return std::max(1U, std::thread::hardware_concurrency());
  constexpr int most = 1024;
  if (*threads >= 1 && *threads <= most) return static_cast<std::size_t>(*threads);
  throw scene::SceneError("threads", std::to_string(*threads), "1 to " + std::to_string(most) + ", or None");
}

std::vector<std::string> fields_of(const py::object& fields) {
  std::vector<std::string> names;
  for (const py::handle field : py::tuple(fields)) names.push_back(text_of(field, "fields"));
  return names;
}

Runs run_many(const py::object& scenes, const py::object& times, const py::object& samples,
              const py::object& fields, bool switches, const std::optional<int>& threads) {
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
  const std::size_t width = region_width(request);
  const StateLayout layout(fields_of(fields), width);
  Runs runs;
  runs.states = unset_array(layout.dtype(), {request.runs, request.times.size()});
  Batch batch(request, layout, static_cast<char*>(runs.states.mutable_data()));
  Signals signals;
  try {
    const WithoutLock unlocked;
    batch.compute([&signals] { return signals.have_come(); });
  } catch (const Interrupted&) {
    signals.rethrow();
  }
  runs.switches = switches ? py::object(batch.take_switches().array(true, width)) : py::none();
  for (const BatchHalt& halt : batch.halts()) {
    runs.halts[py::int_(halt.run)] = halted(halt.error, py::none());
  }
  return runs;
}

constexpr const char* run_many_doc =
    R"(Computes many runs from time 0, with the lock of the interpreter released.

scenes    some scenes, each as Simulation takes it; or one scene, for all samples
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
  module.def("run_many", &run_many, run_many_doc, py::arg("scenes"), py::arg("times"),
             py::arg("samples") = py::none(), py::kw_only(), py::arg("fields") = py::tuple(),
             py::arg("switches") = false, py::arg("threads") = 1);
}

}  // namespace hybrid_sphere::python
