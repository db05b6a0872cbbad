#include "hybrid_sphere/cli/table.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <ostream>

#include "hybrid_sphere/scene/printable.hpp"

namespace hybrid_sphere::cli {
namespace {

bool is_file(const std::string& path) { return !path.empty() && path != "-"; }

}  // namespace

Table::Table(const std::string& path, const std::string& header, std::ostream& out) : path_(path) {
  if (path.empty()) return;
  stream_ = &out;
  if (path != "-") {
    errno = 0;
    file_.open(path, std::ios::binary | std::ios::trunc);
    stream_ = &file_;
    check();
  }
  text_ = header + '\n';
}

void Table::write() {
  if (!wanted()) return;
  errno = 0;
  stream_->write(text_.data(), static_cast<std::streamsize>(text_.size())).flush();
  text_.clear();
  check();
}

void Table::check() const {
  if (stream_->good()) return;
  throw WriteError((path_ == "-" ? "standard output" : "\"" + path_ + "\"") +
                   " cannot be written: " + (errno != 0 ? std::strerror(errno) : "write failed"));
}

bool same_file(const std::string& a, const std::string& b) {
  if (!is_file(a) || !is_file(b)) return false;
  std::error_code ignored;
  const bool regular = std::filesystem::is_regular_file(a, ignored) || !std::filesystem::exists(a, ignored);
  const auto canonical = [&ignored](const std::string& path) {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path, ignored), ignored);
  };
  return regular && (canonical(a) == canonical(b) || std::filesystem::equivalent(a, b, ignored));
}

std::string refusal(const std::string& option, const std::string& value, const std::string& allowed) {
  return option + ": \"" + scene::escaped(value) + "\" is refused; allowed: " + allowed;
}

}  // namespace hybrid_sphere::cli
