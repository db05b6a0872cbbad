#pragma once

#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace hybrid_sphere::cli {

/// Something that cannot be written.
struct WriteError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A file, or standard output.
class OutputFile {
 public:
  /// @param path  a file, which is emptied, or "-" for `out`. Throws WriteError.
  OutputFile(const std::string& path, std::ostream& out);

  /// Writes all of the text to its end. Throws WriteError.
  void write(std::string_view text);

 private:
  void check() const;

  std::string path_;
  std::ofstream file_;
  std::ostream* stream_;
};

}  // namespace hybrid_sphere::cli
