#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "study/columns.hpp"

namespace hybrid_sphere::study {

/// A sample that the scene refuses.
struct Refusal {
  std::uint64_t run;
  std::string path;
  std::string value;
};

/// The results of some runs in a row, a column after another.
class Chunk {
 public:
  /// @param columns  have to live as long as this
  explicit Chunk(const std::vector<Column>& columns) : columns_(&columns) {}

  /// Runs first .. first + count - 1, all of whose values are missing: NaN, or the code -1.
  void begin(std::uint64_t first, std::uint64_t count);

  std::uint64_t first() const { return first_; }
  std::uint64_t count() const { return count_; }
  /// The numbers of one run, by its index in the chunk.
  double* reals(std::size_t column, std::uint64_t run) {
    return reinterpret_cast<double*>(bytes_.data() + offsets_[column]) + run * sizes_[column];
  }
  std::int32_t* codes(std::size_t column, std::uint64_t run) {
    return reinterpret_cast<std::int32_t*>(bytes_.data() + offsets_[column]) + run * sizes_[column];
  }
  std::vector<Refusal> refusals;

  /// The bytes that are sent and written: each column compressed where that saves space, then the refusals.
  void encode(std::vector<unsigned char>& out) const;

 private:
  const std::vector<Column>* columns_;
  std::uint64_t first_ = 0;
  std::uint64_t count_ = 0;
  std::vector<std::size_t> offsets_;  // in bytes_, multiples of 8
  std::vector<std::size_t> sizes_;    // numbers of each run
  std::vector<unsigned char> bytes_;
};

/// A column in the bytes of a chunk.
struct EncodedColumn {
  bool is_packed = false;    ///< by shuffling its bytes, then zlib, as the filters of HDF5 do
  bool is_constant = false;  ///< the numbers of one run, which are those of all
  const unsigned char* bytes = nullptr;
  std::size_t size = 0;
};

/// Where the columns are in encoded bytes. @throws std::runtime_error  if they are not those of a chunk
std::vector<EncodedColumn> columns_in(const std::vector<unsigned char>& encoded, std::size_t columns);
std::vector<Refusal> refusals_in(const std::vector<unsigned char>& encoded, std::size_t columns);

/// The numbers of a column. @param bytes  of all of them
std::vector<unsigned char> unpacked(const EncodedColumn& column, std::size_t number_size, std::size_t bytes);

/// Packs numbers as the filters of HDF5 do.
std::vector<unsigned char> packed(const unsigned char* bytes, std::size_t size, std::size_t number_size);

}  // namespace hybrid_sphere::study
