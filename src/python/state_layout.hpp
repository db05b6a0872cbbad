#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "hybrid_sphere/simulation/records.hpp"
#include "python/forward.hpp"

namespace hybrid_sphere::python {

/// How a state lies in a numpy array: the fields are the columns of the states that `simulate` writes.
class StateLayout {
 public:
  /// @param fields        names of columns, in this order; empty: all
  /// @param region_width  characters of the longest name of a region, at least 1
  /// @throws SceneError   for a name that is no column, or twice the same
  StateLayout(const std::vector<std::string>& fields, std::size_t region_width);

  /// Items have attributes: states[0].x. To be called with the lock of the interpreter.
  pybind11::dtype dtype() const;
  std::size_t item_size() const { return size_; }
  bool has_orientation() const { return has_orientation_; }

  /// Puts a state where an item of the array is.
  void put(const State& state, char* item) {
    if (state.mode != mode_ || state.region.data() != region_ || state.region.size() != region_size_) {
      put_texts(state);
    }
    if (parts_.empty()) {
      put_numbers(state, item);
      copy_blocks(record_.data() + stage_at, item + stage_at, size_ - stage_at);
      item[stage_at] = static_cast<char>(state.stage);
    } else {
      put_numbers(state, record_.data());
      record_[stage_at] = static_cast<char>(state.stage);
      for (const Part& part : parts_) std::memcpy(&item_[part.to], &record_[part.from], part.size);
      std::memcpy(item, item_.data(), size_);
    }
  }

  /// Names of regions at known addresses may be other ones from now on.
  void forget_names() { region_size_ = unknown; }

 private:
  /// Bytes of the whole record that a field, or several that follow one another, have in an item.
  struct Part {
    std::size_t from;
    std::size_t to;
    std::size_t size;
  };
  struct Field {
    const char* name;
    std::string format;  // as numpy calls it
    std::size_t offset;  // in the whole record
    std::size_t size;
  };

  static constexpr std::size_t numbers = 12;  // t to wz
  static constexpr std::size_t stage_at = numbers * sizeof(double);

  /// Of some hundred bytes, 16 at least, this is faster than a call of memcpy, and than a loop that first
  /// looks whether they overlap.
  static void copy_blocks(const char* from, char* to, std::size_t size) {
    constexpr std::size_t block = 16;
    std::size_t i = 0;
    for (; i + block < size; i += block) std::memcpy(to + i, from + i, block);
    std::memcpy(to + size - block, from + size - block, block);
  }
  /// Whole vectors, as they were stored: loads across two of them wait for both.
  static void put_numbers(const State& state, char* record) {
    std::size_t place = 0;
    const auto put = [&](const auto& numbers) {
      std::memcpy(record + place, numbers.data(), sizeof numbers);
      place += sizeof numbers;
    };
    std::memcpy(record, &state.time, sizeof state.time);
    place = sizeof state.time;
    put(state.position);
    put(state.orientation.coeffs());
    put(state.twist.velocity);
    put(state.twist.angular_velocity);
  }
  static std::vector<Field> whole_record(std::size_t region_width);
  void put_texts(const State& state);

  std::size_t region_width_;
  std::vector<Field> chosen_;
  std::vector<Part> parts_;           // none: the whole record
  std::vector<std::size_t> offsets_;  // of the chosen fields in an item
  std::size_t size_ = 0;
  bool has_orientation_ = true;
  std::vector<char> record_;  // the whole one of the last state
  std::vector<char> item_;    // its chosen fields
  static constexpr std::size_t unknown = static_cast<std::size_t>(-1);
  const char* region_ = nullptr;  // whose name is in it
  std::size_t region_size_ = unknown;
  Mode mode_ = Mode::free;
};

/// Characters of the longest name of a ground, as numpy counts them.
std::size_t longest_region_name(const scene::Surface& surface);

}  // namespace hybrid_sphere::python
