#include "python/kept_switches.hpp"

#include <cstring>
#include <iterator>
#include <tuple>
#include <utility>

#include "python/numpy_text.hpp"
#include "python/record_dtype.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;

constexpr std::size_t kind_width = 9;    // "exchanged"
constexpr std::size_t cause_width = 14;  // "livelock ended"
constexpr const char* number_fields[] = {"x",   "y",   "Px",  "Py",      "Lx",     "Ly",  "Lz",
                                         "vx1", "vy1", "wx1", "wy1",     "wz1",    "vx2", "vy2",
                                         "wx2", "wy2", "wz2", "energy1", "energy2"};

/// Where the fields of an item are.
class Layout {
 public:
  Layout(bool with_runs, std::size_t region_width) {
    if (with_runs) add("run", "<u8", 8);
    add("index", "<u8", 8);
    add("t", "<f8", 8);
    kind_at = add_text("kind", kind_width);
    from_at = add_text("from_region", region_width);
    to_at = add_text("to_region", region_width);
    size_ = (size_ + 7) / 8 * 8;
    numbers_at = size_;
    for (const char* name : number_fields) add(name, "<f8", 8);
    cause_at = add_text("cause", cause_width);
    size_ = (size_ + 7) / 8 * 8;
  }

  py::dtype dtype() const { return record_dtype(names_, formats_, offsets_, size_); }
  std::size_t size() const { return size_; }

  std::size_t kind_at = 0;
  std::size_t from_at = 0;
  std::size_t to_at = 0;
  std::size_t numbers_at = 0;
  std::size_t cause_at = 0;

 private:
  std::size_t add(const char* name, const std::string& format, std::size_t size) {
    names_.append(name);
    formats_.append(format);
    offsets_.append(size_);
    return std::exchange(size_, size_ + size);
  }
  std::size_t add_text(const char* name, std::size_t width) {
    return add(name, "<U" + std::to_string(width), width * sizeof(char32_t));
  }

  py::list names_;
  py::list formats_;
  py::list offsets_;
  std::size_t size_ = 0;
};

void put_numbers(const Switch& event, char* to) {
  const auto& [p, impulse, couple] = std::tie(event.position, event.impulse, event.angular_impulse);
  const auto& [v1, w1] = std::tie(event.before.velocity, event.before.angular_velocity);
  const auto& [v2, w2] = std::tie(event.after.velocity, event.after.angular_velocity);
  const double values[std::size(number_fields)] = {p.x(),
                                                   p.y(),
                                                   impulse.x(),
                                                   impulse.y(),
                                                   couple.x(),
                                                   couple.y(),
                                                   couple.z(),
                                                   v1.x(),
                                                   v1.y(),
                                                   w1.x(),
                                                   w1.y(),
                                                   w1.z(),
                                                   v2.x(),
                                                   v2.y(),
                                                   w2.x(),
                                                   w2.y(),
                                                   w2.z(),
                                                   event.energy_before,
                                                   event.energy_after};
  std::memcpy(to, values, sizeof values);
}

}  // namespace

void KeptSwitches::add(const Switch& event, std::uint64_t run) {
  kept_.push_back({event, std::string(event.from_region), std::string(event.to_region), run});
}

void KeptSwitches::append(KeptSwitches&& others) {
  std::move(others.kept_.begin(), others.kept_.end(), std::back_inserter(kept_));
  others.kept_.clear();
}

py::array KeptSwitches::array(bool with_runs, std::size_t region_width) const {
  const Layout layout(with_runs, region_width);
  py::array result(layout.dtype(), kept_.size());
  char* item = static_cast<char*>(result.mutable_data());
  std::memset(item, 0, kept_.size() * layout.size());
  for (const Kept& kept : kept_) {
    char* to = item;
    if (with_runs) {
      std::memcpy(to, &kept.run, sizeof kept.run);
      to += sizeof kept.run;
    }
    std::memcpy(to, &kept.event.index, sizeof kept.event.index);
    std::memcpy(to + sizeof kept.event.index, &kept.event.time, sizeof kept.event.time);
    put_text(numpy_text(to_string(kept.event.kind)), kind_width, item + layout.kind_at);
    put_text(numpy_text(kept.from_region), region_width, item + layout.from_at);
    put_text(numpy_text(kept.to_region), region_width, item + layout.to_at);
    put_numbers(kept.event, item + layout.numbers_at);
    put_text(numpy_text(to_string(kept.event.cause)), cause_width, item + layout.cause_at);
    item += layout.size();
  }
  return result;
}

}  // namespace hybrid_sphere::python
