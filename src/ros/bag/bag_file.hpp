#pragma once

#include <fcntl.h>
#include <rosbag/bag.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <string>

#include "cli/table.hpp"

namespace hybrid_sphere::ros_interface {

/// A bag that is being written, by one process at a time. Once something could not be written nothing more
/// is; `rosbag reindex` recovers what has been.
class BagFile {
 public:
  /// @param file  is overwritten
  /// @throws cli::WriteError
  explicit BagFile(const std::string& file) : file_(file), bag_(std::make_unique<rosbag::Bag>()) {
    lock();
    attempt([this] { bag_->open(file_, rosbag::bagmode::Write); });
  }

  ~BagFile() {
    try {
      if (bag_) close();
    } catch (const cli::WriteError&) {
      // Who wants to know calls close().
    }
    if (descriptor_ >= 0) ::close(descriptor_);
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
  /// Until the end of this object; a file that cannot be opened is left to the bag.
  void lock() {
    constexpr mode_t for_all = 0666;  // but for the umask
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, for_all);
    if (descriptor_ < 0 || flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    ::close(descriptor_);
    throw cli::WriteError("\"" + file_ + "\" is being written by another process");
  }

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
  int descriptor_ = -1;
  std::unique_ptr<rosbag::Bag> bag_;
};

}  // namespace hybrid_sphere::ros_interface
