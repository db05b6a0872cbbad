#pragma once

#include <rosbag/bag.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <string>

#include "cli/table.hpp"

namespace hybrid_sphere::ros_interface {

/// A bag that is being written. Once something could not be written nothing more is; `rosbag reindex`
/// recovers what has been.
class BagFile {
 public:
  /// @param file  is overwritten
  /// @throws cli::WriteError
  explicit BagFile(const std::string& file) : file_(file), bag_(std::make_unique<rosbag::Bag>()) {
    attempt([this] { bag_->open(file_, rosbag::bagmode::Write); });
  }

  ~BagFile() {
    try {
      if (bag_) close();
    } catch (const cli::WriteError&) {
      // Who wants to know calls close().
    }
  }

  BagFile(const BagFile&) = delete;
  BagFile& operator=(const BagFile&) = delete;

  /// As rosbag::Bag::write. Throws cli::WriteError.
  template <class... Arguments>
  void write(const Arguments&... arguments) {
    attempt([&] { bag_->write(arguments...); });
  }

  /// Writes the index; the last call. Throws cli::WriteError.
  void close() {
    attempt([this] { bag_->close(); });
    bag_.reset();
  }

 private:
  template <class Action>
  void attempt(const Action& action) {
    if (!bag_) throw cli::WriteError(failure_);
    errno = 0;
    try {
      action();
    } catch (const std::exception& error) {
      failure_ = "\"" + file_ + "\" cannot be written: " + (errno != 0 ? std::strerror(errno) : error.what());
      // The destructor of a bag closes it, tries to write what is left, and ends the process where that
      // throws.
      static_cast<void>(bag_.release());
      throw cli::WriteError(failure_);
    }
  }

  std::string file_;
  std::string failure_;
  std::unique_ptr<rosbag::Bag> bag_;
};

}  // namespace hybrid_sphere::ros_interface
