#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace hybrid_sphere::cli {

/// A row of a CSV table: numbers of 17 significant digits, which give back the same binary64 number, and
/// texts quoted as in RFC 4180 where they hold a comma or a quote.
class CsvRow {
 public:
  /// @param text  to whose end the row is put
  explicit CsvRow(std::string& text) : text_(text) {}

  CsvRow& operator<<(double number);
  CsvRow& operator<<(std::uint64_t number);
  CsvRow& operator<<(std::string_view text);
  CsvRow& operator<<(const std::string& text) { return *this << std::string_view(text); }
  CsvRow& operator<<(const char* text) { return *this << std::string_view(text); }

  void end() { text_ += '\n'; }

 private:
  void separate();

  std::string& text_;
  bool first_ = true;
};

}  // namespace hybrid_sphere::cli
