#include "python/state_layout.hpp"

#include <algorithm>
#include <utility>

#include "hybrid_sphere/scene/scene_error.hpp"
#include "python/numpy_text.hpp"
#include "python/record_dtype.hpp"
#include "scene/printable.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;

constexpr std::size_t mode_width = 12;  // "edge_sliding"
constexpr std::size_t mode_at = 12 * sizeof(double) + 4;
constexpr std::size_t region_at = mode_at + mode_width * sizeof(char32_t);

constexpr std::size_t rounded_up(std::size_t size, std::size_t step) {
  return (size + step - 1) / step * step;
}

}  // namespace

std::vector<StateLayout::Field> StateLayout::whole_record(std::size_t region_width) {
  std::vector<Field> fields;
  for (const char* name : {"t", "x", "y", "qx", "qy", "qz", "qw", "vx", "vy", "wx", "wy", "wz"}) {
    fields.push_back({name, "<f8", fields.size() * sizeof(double), sizeof(double)});
  }
  fields.push_back({"stage", "u1", stage_at, 1});
  fields.push_back({"mode", "<U" + std::to_string(mode_width), mode_at, mode_width * sizeof(char32_t)});
  fields.push_back(
      {"region", "<U" + std::to_string(region_width), region_at, region_width * sizeof(char32_t)});
  return fields;
}

StateLayout::StateLayout(const std::vector<std::string>& fields, std::size_t region_width)
    : region_width_(region_width), chosen_(whole_record(region_width)) {
  const std::size_t whole = rounded_up(region_at + region_width * sizeof(char32_t), sizeof(double));
  record_.assign(whole, 0);
  if (fields.empty()) {
    for (const Field& field : chosen_) offsets_.push_back(field.offset);
    size_ = whole;
    return;
  }
  const std::vector<Field> all = std::move(chosen_);
  chosen_.clear();
  for (const std::string& name : fields) {
    const auto is_named = [&name](const Field& field) { return field.name == name; };
    const auto field = std::find_if(all.begin(), all.end(), is_named);
    const bool again = std::any_of(chosen_.begin(), chosen_.end(), is_named);
    if (field == all.end() || again) {
      std::string allowed;
      for (const Field& one : all) allowed += (allowed.empty() ? "" : ", ") + std::string(one.name);
      throw scene::SceneError("fields", "\"" + scene::printable(name) + "\"", allowed + ", each once");
    }
    chosen_.push_back(*field);
    const std::size_t unit = field->size == 1                                    ? 1
                             : field->size == sizeof(double) && name != "region" ? sizeof(double)
                                                                                 : sizeof(char32_t);
    const std::size_t to = rounded_up(size_, unit);
    offsets_.push_back(to);
    parts_.push_back({field->offset, to, field->size});
    size_ = to + field->size;
  }
  size_ = rounded_up(size_, sizeof(double));
  item_.assign(size_, 0);
  has_orientation_ =
      std::any_of(fields.begin(), fields.end(), [](const std::string& name) { return name[0] == 'q'; });
}

py::dtype StateLayout::dtype() const {
  py::list names;
  py::list formats;
  py::list offsets;
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    names.append(chosen_[i].name);
    formats.append(chosen_[i].format);
    offsets.append(offsets_[i]);
  }
  return record_dtype(names, formats, offsets, size_);
}

void StateLayout::put_texts(const State& state) {
  mode_ = state.mode;
  region_ = state.region.data();
  region_size_ = state.region.size();
  put_text(numpy_text(to_string(mode_)), mode_width, record_.data() + mode_at);
  put_text(numpy_text(state.region), region_width_, record_.data() + region_at);
}

std::size_t longest_region_name(const scene::Surface& surface) {
  std::size_t longest = numpy_text(scene::base_name).size();
  for (const scene::Region& region : surface.regions) {
    longest = std::max(longest, numpy_text(region.name).size());
  }
  return longest;
}

}  // namespace hybrid_sphere::python
