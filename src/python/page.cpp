#include "python/page.hpp"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "html/page.hpp"
#include "html/recording.hpp"
#include "python/interpreter_lock.hpp"
#include "python/numbers_of.hpp"
#include "python/scene_of.hpp"
#include "python/tree_of.hpp"
#include "scene/printable.hpp"
#include "scene/tree.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;
using scene::SceneError;

/// The fields of a structured array, or the lists of a dict, by their names.
class TableColumns {
 public:
  /// @param name  put before the fields in refusals
  TableColumns(py::object source, std::string name) : source_(std::move(source)), name_(std::move(name)) {
    size_ = numbers("t").size();
  }

  std::size_t size() const { return size_ ? *size_ : 0; }
  bool has(const char* field) const { return find(field).has_value(); }

  /// @throws SceneError  for what is missing, not as long as t, no number or not finite
  std::vector<double> numbers(const char* field) {
    const Numbers column = numbers_of(list(field), name_ + "." + field);
    if (column.ndim() != 1) refuse(field, "not a list", "a list of numbers");
    std::vector<double> values(static_cast<std::size_t>(column.size()));
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = column.at(static_cast<py::ssize_t>(i));
      if (!std::isfinite(values[i])) {
        refuse(std::string(field) + "[" + std::to_string(i) + "]", text::shortest(values[i]),
               "finite numbers");
      }
    }
    require_size(field, values.size());
    return values;
  }

  std::vector<std::string> texts(const char* field) {
    std::vector<std::string> values;
    for (const py::handle value : py::tuple(list(field))) {
      const scene::Tree text = tree_of(value, name_ + "." + field);
      if (!text.as_text()) refuse(field, "not a list of texts", "a list of texts");
      values.emplace_back(*text.as_text());
    }
    require_size(field, values.size());
    return values;
  }

  /// Texts that are names of an enumeration, from `first` to `last`.
  template <class Code>
  std::vector<Code> codes(const char* field, Code first, Code last) {
    std::vector<Code> values;
    for (const std::string& text : texts(field)) {
      std::string allowed;
      std::optional<Code> found;
      for (int i = static_cast<int>(first); i <= static_cast<int>(last); ++i) {
        const std::string name = to_string(static_cast<Code>(i));
        if (name == text) found = static_cast<Code>(i);
        allowed += (allowed.empty() ? "" : ", ") + name;
      }
      if (!found) refuse(field, '"' + scene::printable(text) + '"', allowed);
      values.push_back(*found);
    }
    return values;
  }

  /// @throws SceneError  for the first value that does not have a property
  template <class Property>
  void require(const std::vector<double>& values, const char* field, const char* allowed,
               Property has) const {
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!has(values[i])) {
        refuse(std::string(field) + "[" + std::to_string(i) + "]", text::shortest(values[i]), allowed);
      }
    }
  }

 private:
  std::optional<py::object> find(const char* field) const {
    try {
      return py::object(source_[field]);
    } catch (py::error_already_set& error) {
      const bool is_missing = error.matches(PyExc_LookupError) || error.matches(PyExc_TypeError) ||
                              error.matches(PyExc_ValueError);
      if (!is_missing) throw;
    }
    return std::nullopt;
  }

  py::object list(const char* field) const {
    if (auto found = find(field)) return *found;
    throw SceneError::missing(name_ + "." + field, "the columns of the tables that simulate writes");
  }

  void require_size(const char* field, std::size_t size) const {
    if (!size_ || size == *size_) return;
    refuse(field, std::to_string(size) + " values", std::to_string(*size_) + ", as of t");
  }

  [[noreturn]] void refuse(const std::string& field, const std::string& value,
                           const std::string& allowed) const {
    throw SceneError(name_ + "." + field, value, allowed);
  }

  py::object source_;
  std::string name_;
  std::optional<std::size_t> size_;
};

void add_states(const py::object& source, html::Recording& recording) {
  TableColumns columns(source, "states");
  std::vector<std::vector<double>> numbers;
  for (const char* name : {"t", "x", "y", "qx", "qy", "qz", "qw", "vx", "vy", "wx", "wy", "wz", "stage"}) {
    numbers.push_back(columns.numbers(name));
  }
  columns.require(numbers[0], "t", "ascending times",
                  [before = -HUGE_VAL](double t) mutable { return t >= std::exchange(before, t); });
  columns.require(numbers[12], "stage", "1, 3", [](double stage) { return stage == 1 || stage == 3; });
  const auto modes = columns.codes("mode", Mode::free, Mode::resting);
  const auto regions = columns.texts("region");
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto at = [&](std::size_t column) { return numbers[column][i]; };
    State state;
    state.time = at(0);
    state.position = {at(1), at(2)};
    state.orientation = Quaterniond(at(6), at(3), at(4), at(5));
    state.twist = {{at(7), at(8)}, {at(9), at(10), at(11)}};
    state.stage = at(12) == 3 ? Stage::nonholonomic : Stage::holonomic;
    state.mode = modes[i];
    state.region = regions[i];
    recording.add(state);
  }
}

void add_switches(const py::object& source, html::Recording& recording) {
  TableColumns columns(source, "switches");
  std::vector<std::vector<double>> numbers;
  for (const char* name : {"t",   "x",   "y",   "Px",  "Py",  "Lx",  "Ly",  "Lz",  "vx1",     "vy1",
                           "wx1", "wy1", "wz1", "vx2", "vy2", "wx2", "wy2", "wz2", "energy1", "energy2"}) {
    numbers.push_back(columns.numbers(name));
  }
  columns.require(numbers[0], "t", "ascending times",
                  [before = -HUGE_VAL](double t) mutable { return t >= std::exchange(before, t); });
  const auto kinds = columns.codes("kind", SwitchKind::applied, SwitchKind::exchanged);
  std::vector<Cause> causes;
  if (columns.has("cause")) causes = columns.codes("cause", Cause::edge, Cause::accumulation);
  const auto from = columns.texts("from_region");
  const auto to = columns.texts("to_region");
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto at = [&](std::size_t column) { return numbers[column][i]; };
    Switch event;
    event.time = at(0);
    event.kind = kinds[i];
    if (!causes.empty()) event.cause = causes[i];
    event.from_region = from[i];
    event.to_region = to[i];
    event.position = {at(1), at(2)};
    event.impulse = {at(3), at(4)};
    event.angular_impulse = {at(5), at(6), at(7)};
    event.before = {{at(8), at(9)}, {at(10), at(11), at(12)}};
    event.after = {{at(13), at(14)}, {at(15), at(16), at(17)}};
    event.energy_before = at(18);
    event.energy_after = at(19);
    recording.add(event, !causes.empty());
  }
}

std::vector<std::string> write_html(const py::object& file, const py::object& scene, const py::object& states,
                                    const py::object& switches, const std::string& title,
                                    const std::string& ended) {
  if (!html::can_write_pages()) {
    throw std::runtime_error("write_html: built without three.js; Debian's package libjs-three has it");
  }
  const scene::Scene read = scene_of(source_of(scene));
  html::Recording recording;
  add_states(states, recording);
  if (!switches.is_none()) add_switches(switches, recording);
  std::ostringstream page;
  std::vector<std::string> left_out;
  {
    const WithoutLock unlocked;
    left_out = html::write_page(read, recording, {title, ended}, page);
  }
  const py::object out = py::module_::import("builtins").attr("open")(file, "wb");
  out.attr("write")(py::bytes(page.str()));
  out.attr("close")();
  return left_out;
}

constexpr const char* write_html_doc =
    R"(Writes a run as one HTML file of less than 2 MB that needs no network: the sphere in motion, its switches, plots.

file      the name of the file
scene     as Simulation takes it: the ground, and the sphere
states    as of Simulation.run(): a structured array, or a dict of lists, with the same fields
switches  as of Simulation.switches, without cause where it is not known; None: there are none
title     of the page
ended     why the run ended before its time, which the page says then

Returns what the page leaves out, a sentence each: of more than 10,000 states it has an even choice.

Raises SceneError, and OSError where the file cannot be written.)";

}  // namespace

void declare_page(py::module_& module) {
  module.def("write_html", &write_html, write_html_doc, py::arg("file"), py::arg("scene"), py::arg("states"),
             py::arg("switches") = py::none(), py::kw_only(), py::arg("title") = "", py::arg("ended") = "");
}

}  // namespace hybrid_sphere::python
