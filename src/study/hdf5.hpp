#pragma once

#include <hdf5.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "study/journal.hpp"

namespace hybrid_sphere::study::hdf5 {

/// An open object of HDF5, closed at the end. Throws FileError where a call has failed.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close, const std::string& what) : id_(id), close_(close) {
    if (id_ < 0) throw FileError("HDF5 cannot make " + what);
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor)

 private:
  hid_t id_;
  Close close_;
};

void require(herr_t result, const std::string& what);

/// Makes a file that holds no time of writing. Messages of the library are switched off: errors are thrown.
Handle create_file(const std::string& file);
/// Closes it, so that all is written. @throws FileError
void close(Handle file, const std::string& name);

/// Attributes of a file, a group or a dataset.
void set_attribute(hid_t object, const std::string& name, const std::string& text);
void set_attribute(hid_t object, const std::string& name, double number);
void set_attribute(hid_t object, const std::string& name, std::uint64_t number);

/// Makes a dataset, and the groups on its way.
/// @param chunk  its first dimension, of chunks that are shuffled and deflated; 0: in one piece as it is
Handle create_dataset(hid_t file, const std::string& name, hid_t type,
                      const std::vector<std::uint64_t>& shape, std::uint64_t chunk);

/// Whole datasets.
void write(hid_t file, const std::string& name, const std::vector<double>& numbers,
           const std::vector<std::uint64_t>& shape, const std::string& unit = "");
void write(hid_t file, const std::string& name, const std::vector<std::uint64_t>& numbers);
void write(hid_t file, const std::string& name, const std::vector<std::string>& texts);

}  // namespace hybrid_sphere::study::hdf5
