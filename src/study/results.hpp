#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "study/chunk.hpp"
#include "study/columns.hpp"
#include "study/journal.hpp"
#include "study/statistics.hpp"

namespace hybrid_sphere::study {

/// The results of all runs of a study, from a journal that has all chunks.
class Results {
 public:
  /// @param study, columns, journal  have to live as long as this
  /// @param should_stop              asked whenever a chunk is read, here and later: Interrupted is thrown
  /// then
  Results(
      const Study& study, const Columns& columns, const Journal& journal,
      std::function<bool()> should_stop = [] { return false; });

  const Study& study() const { return *study_; }
  const Columns& columns() const { return *columns_; }
  std::uint64_t chunks() const { return places_.size(); }
  std::uint64_t first_run(std::uint64_t chunk) const { return chunk * study_->chunk; }
  std::uint64_t runs_of(std::uint64_t chunk) const;
  const std::vector<Refusal>& refusals() const { return refusals_; }

  /// The bytes of a column in a chunk of the file. @return  whether they are packed, and they
  std::pair<bool, std::vector<unsigned char>> encoded(std::uint64_t chunk, std::size_t column) const;
  /// The numbers.
  std::vector<unsigned char> numbers(std::uint64_t chunk, std::size_t column) const;

  /// One number of each run of a chunk, NaN where it is missing. @param element  in the array of the column
  std::vector<double> values(std::uint64_t chunk, std::size_t column, std::size_t element) const;
  /// The same of all runs; quick where the elements of a column are asked for one after another.
  Blocks blocks(std::size_t column, std::size_t element) const;
  /// How often each code appears; the last number is that of those that are missing.
  std::vector<std::uint64_t> counts_of_codes(std::size_t column, std::size_t codes) const;

 private:
  struct Place {
    std::uint64_t begin;
    std::uint64_t size;
    bool is_packed;
    bool is_constant;
  };
  std::vector<unsigned char> read(const Place& place, std::uint64_t chunk) const;

  /// Some elements of a column, the numbers of all runs of one after those of another.
  struct Read {
    std::size_t column = 0;
    std::size_t first = 0;
    std::size_t count = 0;
    std::vector<double> numbers;
  };

  const double* all_of(std::size_t column, std::size_t element) const;
  void read_elements(std::size_t column, std::size_t first, std::size_t count) const;

  const Study* study_;
  const Columns* columns_;
  const Journal* journal_;
  std::function<bool()> should_stop_;
  std::vector<std::vector<Place>> places_;  // of each chunk and column
  std::vector<Refusal> refusals_;
  mutable Read read_;  // last
};

}  // namespace hybrid_sphere::study
