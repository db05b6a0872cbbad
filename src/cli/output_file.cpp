#include "cli/output_file.hpp"

#include <cerrno>
#include <cstring>
#include <ostream>

namespace hybrid_sphere::cli {

OutputFile::OutputFile(const std::string& path, std::ostream& out) : path_(path), stream_(&out) {
  if (path == "-") return;
  errno = 0;
  file_.open(path, std::ios::binary | std::ios::trunc);
  stream_ = &file_;
  check();
}

void OutputFile::write(std::string_view text) {
  errno = 0;
  stream_->write(text.data(), static_cast<std::streamsize>(text.size())).flush();
  check();
}

void OutputFile::check() const {
  if (stream_->good()) return;
  throw WriteError((path_ == "-" ? "standard output" : "\"" + path_ + "\"") +
                   " cannot be written: " + (errno != 0 ? std::strerror(errno) : "write failed"));
}

}  // namespace hybrid_sphere::cli
