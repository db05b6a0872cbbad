#pragma once

#include <optional>
#include <string>

#include "cli/output_file.hpp"

namespace hybrid_sphere::cli {

/// A table that goes to a file, to standard output or nowhere.
class Table {
 public:
  /// @param path    a file, "-" for standard output, empty for nowhere
  /// @param header  names of the columns, without a line feed
  /// @param out     standard output
  /// Throws WriteError.
  Table(const std::string& path, const std::string& header, std::ostream& out);

  bool wanted() const { return file_.has_value(); }

  /// Rows that are not written yet; more are put to its end. Only of a table that is wanted.
  std::string& rows() { return text_; }

  /// Throws WriteError.
  void write();

 private:
  std::optional<OutputFile> file_;
  std::string text_;
};

/// Whether two paths name one file, which may not exist yet. "-" and "" are none.
bool same_file(const std::string& a, const std::string& b);

/// "--states: "F" is refused; allowed: ..."
std::string refusal(const std::string& option, const std::string& value, const std::string& allowed);

}  // namespace hybrid_sphere::cli
