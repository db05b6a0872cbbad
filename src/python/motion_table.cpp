#include "python/motion_table.hpp"

#include <algorithm>
#include <cstring>
#include <set>
#include <stdexcept>

#include "python/numpy_text.hpp"
#include "python/record_dtype.hpp"

namespace hybrid_sphere::python {

namespace py = pybind11;

MotionTable::MotionTable(std::vector<Column> columns, const std::string& what)
    : columns_(std::move(columns)) {
  std::set<std::string> names;
  for (const Column& column : columns_) {
    if (!names.insert(column.name).second) {
      throw std::invalid_argument("two columns of " + what + " would be called \"" + column.name +
                                  "\": give a coordinate, velocity or constraint another name");
    }
    if (column.kind == Kind::number) ++number_columns_;
    if (column.kind == Kind::text) texts_.emplace_back();
  }
}

void MotionTable::add_text(const std::string& text) {
  Texts& column = texts_[next_text_];
  next_text_ = (next_text_ + 1) % texts_.size();
  const auto [place, is_new] = column.places.emplace(text, column.known.size());
  if (is_new) column.known.push_back(numpy_text(text));
  column.rows.push_back(place->second);
}

void MotionTable::clear() {
  numbers_.clear();
  wholes_.clear();
  for (Texts& column : texts_) column.rows.clear();
}

/// Numbers first, one after another; the fields are in the order of the columns nevertheless. Texts are as
/// wide as the longest one of the rows.
void MotionTable::make_dtype() {
  std::vector<std::size_t> widths;
  for (const Texts& column : texts_) {
    std::size_t width = 1;
    for (const std::size_t row : column.rows) width = std::max(width, column.known[row].size());
    widths.push_back(width);
  }
  if (dtype_ && widths == text_widths_) return;
  text_widths_ = widths;
  text_offsets_.clear();
  whole_offsets_.clear();
  whole_sizes_.clear();
  std::size_t number_at = 0;
  std::size_t other_at = number_columns_ * sizeof(double);
  const auto reserve = [&](std::size_t size, std::size_t unit) {
    const std::size_t at = (other_at + unit - 1) / unit * unit;
    other_at = at + size;
    return at;
  };
  py::list names, formats, offsets;
  const auto add_field = [&](const std::string& name, const std::string& format, std::size_t offset) {
    names.append(name);
    formats.append(format);
    offsets.append(offset);
  };
  for (const Column& column : columns_) {
    if (column.kind == Kind::number) {
      add_field(column.name, "<f8", number_at);
      number_at += sizeof(double);
    } else if (column.kind == Kind::text) {
      const std::size_t width = widths[text_offsets_.size()];
      text_offsets_.push_back(reserve(width * sizeof(char32_t), sizeof(char32_t)));
      add_field(column.name, "<U" + std::to_string(width), text_offsets_.back());
    } else {
      whole_sizes_.push_back(column.kind == Kind::byte ? 1 : sizeof(std::uint64_t));
      whole_offsets_.push_back(reserve(whole_sizes_.back(), whole_sizes_.back()));
      add_field(column.name, column.kind == Kind::byte ? "u1" : "<u8", whole_offsets_.back());
    }
  }
  item_size_ = reserve(0, sizeof(double));
  dtype_ = record_dtype(names, formats, offsets, item_size_);
}

py::array MotionTable::array() {
  make_dtype();
  const std::size_t count = rows();
  py::array result(py::reinterpret_borrow<py::dtype>(dtype_), count);
  auto* item = static_cast<char*>(result.mutable_data());
  std::memset(item, 0, count * item_size_);
  const std::size_t numbers_size = number_columns_ * sizeof(double);
  for (std::size_t row = 0; row < count; ++row, item += item_size_) {
    std::memcpy(item, numbers_.data() + row * number_columns_, numbers_size);
    for (std::size_t i = 0; i < whole_offsets_.size(); ++i) {
      // Little-endian: the lowest byte is the first one.
      std::memcpy(item + whole_offsets_[i], &wholes_[row * whole_offsets_.size() + i], whole_sizes_[i]);
    }
    for (std::size_t i = 0; i < texts_.size(); ++i) {
      put_text(texts_[i].known[texts_[i].rows[row]], text_widths_[i], item + text_offsets_[i]);
    }
  }
  return result;
}

}  // namespace hybrid_sphere::python
