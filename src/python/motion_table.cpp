#include "python/motion_table.hpp"

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
  const auto reserve = [this](std::size_t size, std::size_t unit) {
    item_size_ = (item_size_ + unit - 1) / unit * unit;
    offsets_.push_back(item_size_);
    item_size_ += size;
  };
  for (const Column& column : columns_) {
    if (!names.insert(column.name).second) {
      throw std::invalid_argument("two columns of " + what + " would be called \"" + column.name +
                                  "\": give a coordinate, velocity or constraint another name");
    }
    if (column.kind == Kind::number) ++number_columns_;
    if (column.kind == Kind::text) texts_.emplace_back();
    const std::size_t size = size_of(column);
    reserve(size, column.kind == Kind::text ? sizeof(char32_t) : size);
  }
  item_size_ = (item_size_ + 7) / 8 * 8;
}

std::size_t MotionTable::size_of(const Column& column) const {
  switch (column.kind) {
    case Kind::number: return sizeof(double);
    case Kind::byte: return 1;
    case Kind::count: return sizeof(std::uint64_t);
    case Kind::text: return column.width * sizeof(char32_t);
  }
  return 0;
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

py::dtype MotionTable::dtype() const {
  const auto format_of = [](const Column& column) -> std::string {
    switch (column.kind) {
      case Kind::number: return "<f8";
      case Kind::byte: return "u1";
      case Kind::count: return "<u8";
      case Kind::text: break;
    }
    return "<U" + std::to_string(column.width);
  };
  py::list names, formats, offsets;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    names.append(columns_[i].name);
    formats.append(format_of(columns_[i]));
    offsets.append(offsets_[i]);
  }
  return record_dtype(names, formats, offsets, item_size_);
}

py::array MotionTable::array() {
  const std::size_t count = rows();
  if (!dtype_) dtype_ = dtype();
  py::array result(py::reinterpret_borrow<py::dtype>(dtype_), count);
  auto* item = static_cast<char*>(result.mutable_data());
  std::memset(item, 0, count * item_size_);
  const double* number = numbers_.data();
  const std::uint64_t* whole = wholes_.data();
  for (std::size_t row = 0; row < count; ++row, item += item_size_) {
    auto texts = texts_.begin();
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      char* const to = item + offsets_[i];
      switch (columns_[i].kind) {
        case Kind::number: std::memcpy(to, number++, sizeof(double)); break;
        case Kind::byte: *to = static_cast<char>(*whole++); break;
        case Kind::count: std::memcpy(to, whole++, sizeof(std::uint64_t)); break;
        case Kind::text:
          put_text(texts->known[texts->rows[row]], columns_[i].width, to);
          ++texts;
          break;
      }
    }
  }
  return result;
}

}  // namespace hybrid_sphere::python
