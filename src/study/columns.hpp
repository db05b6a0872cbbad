#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "study/study.hpp"

namespace hybrid_sphere::study {

/// How a run ended.
enum class Outcome : std::int32_t { done = 0, halted = 1, refused = 2 };

/// One quantity of all runs: a number or an array of numbers of each run.
struct Column {
  enum class Type : std::uint8_t { real, code };  ///< double; std::int32_t

  std::string name;                  ///< in the file: end/position
  std::vector<std::uint64_t> shape;  ///< of the array; empty: a number
  std::string unit;
  Type type = Type::real;
  std::vector<std::string> names;  ///< of the codes 0, 1, 2 ...
  std::string comment;

  std::size_t size() const {  ///< numbers of each run
    std::size_t product = 1;
    for (const std::uint64_t length : shape) product *= length;
    return product;
  }
  std::size_t bytes() const {  ///< of each run
    return size() * (type == Type::real ? sizeof(double) : sizeof(std::int32_t));
  }
};

/// The columns of a study, and where each kind of them begins.
struct Columns {
  std::vector<Column> all;
  std::size_t outcome = 0;
  std::size_t stop = 0;
  std::size_t stopped_at = 0;
  std::size_t end = 0;
  std::size_t at = 0;
  std::size_t switches = 0;
  std::size_t entered = 0;
  std::size_t extremes = 0;
};

/// @param scene  of which the runs are
Columns columns_of(const Study& study, const scene::Scene& scene);

}  // namespace hybrid_sphere::study
