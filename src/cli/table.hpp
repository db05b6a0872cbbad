#pragma once

#include <fstream>
#include <stdexcept>
#include <string>

namespace hybrid_sphere::cli {

/// Something that cannot be written.
struct WriteError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A table that goes to a file, to standard output or nowhere.
class Table {
 public:
  /// @param path    a file, "-" for standard output, empty for nowhere
  /// @param header  names of the columns, without a line feed
  /// @param out     standard output
  /// Throws WriteError.
  Table(const std::string& path, const std::string& header, std::ostream& out);

  bool wanted() const { return stream_ != nullptr; }

  /// Rows that are not written yet; more are put to its end. Only of a table that is wanted.
  std::string& rows() { return text_; }

  /// Throws WriteError.
  void write();

 private:
  void check() const;

  std::string path_;
  std::ofstream file_;
  std::ostream* stream_ = nullptr;
  std::string text_;
};

/// Whether two paths name one file, which may not exist yet. "-" and "" are none.
bool same_file(const std::string& a, const std::string& b);

/// "--states: "F" is refused; allowed: ..."
std::string refusal(const std::string& option, const std::string& value, const std::string& allowed);

}  // namespace hybrid_sphere::cli
