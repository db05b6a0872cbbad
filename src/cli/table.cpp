#include "cli/table.hpp"

#include <filesystem>

#include "scene/printable.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::cli {
namespace {

namespace fs = std::filesystem;

bool is_file(const std::string& path) { return !path.empty() && path != "-"; }

/// What opening a path for writing opens or makes: links are followed, also where nothing is at their end
/// yet.
fs::path opened(fs::path path) {
  std::error_code ignored;
  constexpr int max_links = 40;  // Linux follows no more
  for (int i = 0; i < max_links && fs::is_symlink(path, ignored); ++i) {
    path = path.parent_path() / fs::read_symlink(path, ignored);
  }
  return fs::weakly_canonical(fs::absolute(path, ignored), ignored);
}

}  // namespace

Table::Table(const std::string& path, const std::string& header, std::ostream& out) {
  if (path.empty()) return;
  file_.emplace(path, out);
  text_ = header + '\n';
}

void Table::write() {
  if (!wanted()) return;
  file_->write(text_);
  text_.clear();
}

bool same_file(const std::string& a, const std::string& b) {
  if (!is_file(a) || !is_file(b)) return false;
  std::error_code ignored;
  const bool regular = fs::is_regular_file(a, ignored) || !fs::exists(a, ignored);
  return regular && (opened(a) == opened(b) || fs::equivalent(a, b, ignored));
}

std::string refusal(const std::string& option, const std::string& value, const std::string& allowed) {
  return text::refusal(option + ": \"" + scene::escaped(value) + "\"", allowed);
}

}  // namespace hybrid_sphere::cli
