#pragma once

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace hybrid_sphere::study {

/// The file of results cannot be read or written: what() says which and why.
struct FileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// It is the file of something else.
struct ForeignFile : FileError {
  using FileError::FileError;
};

/// The chunks that are finished, in the order in which they came, in a file beside that of the results. What
/// is in it outlives a crash at any instant: a record that is not whole is cut off by the next one who opens
/// it.
class Journal {
 public:
  /// Makes the file, which must not be there yet.
  /// @param identity  of the study and the version
  static Journal create(const std::string& file, const std::string& identity);
  /// Opens the file of an earlier process, and locks it.
  /// @throws ForeignFile  if it has another identity
  static Journal open(const std::string& file, const std::string& identity);

  ~Journal();
  Journal(Journal&& other) noexcept;
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  void append(std::uint64_t chunk, const std::vector<unsigned char>& bytes);
  bool has(std::uint64_t chunk) const { return places_.count(chunk) > 0; }
  std::uint64_t chunks() const { return places_.size(); }
  /// Of all chunks.
  std::uint64_t bytes() const { return end_; }

  /// The bytes of a chunk that it has, or a part of them.
  std::vector<unsigned char> read(std::uint64_t chunk) const;
  std::vector<unsigned char> read(std::uint64_t chunk, std::uint64_t begin, std::uint64_t size) const;

 private:
  struct Place {
    std::uint64_t begin;
    std::uint64_t size;
  };
  Journal(std::string file, int descriptor) : file_(std::move(file)), descriptor_(descriptor) {}

  void lock() const;
  void find_records(const std::string& identity);
  void write(const void* head, std::size_t head_size, const std::vector<unsigned char>& bytes);
  bool read_at(std::uint64_t begin, void* bytes, std::size_t size) const;
  [[noreturn]] void fail(const char* what) const;

  std::string file_;
  int descriptor_;
  std::uint64_t end_ = 0;
  std::map<std::uint64_t, Place> places_;
};

}  // namespace hybrid_sphere::study
