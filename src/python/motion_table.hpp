#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace hybrid_sphere::python {

/// Rows of numbers, whole numbers and texts, and the structured array of them. What adds rows needs no lock
/// of the interpreter, all else does.
class MotionTable {
 public:
  enum class Kind { number, byte, count, text };
  struct Column {
    std::string name;
    Kind kind = Kind::number;
    std::size_t width = 1;  ///< of a text, characters of the longest one
  };

  /// Throws std::invalid_argument if two columns have the same name. @param what  "the states"
  MotionTable(std::vector<Column> columns, const std::string& what);

  /// The cells of a row, those of each kind in the order of their columns.
  void add_number(double number) { numbers_.push_back(number); }
  void add_whole(std::uint64_t number) { wholes_.push_back(number); }
  void add_text(const std::string& text);

  std::size_t rows() const { return numbers_.size() / number_columns_; }
  void clear();
  /// (rows), with the fields as attributes of its items.
  pybind11::array array();

 private:
  struct Texts {
    std::map<std::string, std::size_t> places;
    std::vector<std::u32string> known;  // as numpy has them
    std::vector<std::size_t> rows;      // which
  };

  std::size_t size_of(const Column& column) const;
  pybind11::dtype dtype() const;

  std::vector<Column> columns_;
  std::vector<std::size_t> offsets_;  // in an item
  std::size_t item_size_ = 0;
  std::size_t number_columns_ = 0;
  std::vector<double> numbers_;
  std::vector<std::uint64_t> wholes_;
  std::vector<Texts> texts_;
  std::size_t next_text_ = 0;
  pybind11::object dtype_;  // made once
};

}  // namespace hybrid_sphere::python
