#include "cli/csv_row.hpp"

#include <charconv>

namespace hybrid_sphere::cli {

CsvRow& CsvRow::operator<<(double number) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, number, std::chars_format::general, 17).ptr;
  return *this << std::string_view(buffer, static_cast<std::size_t>(end - buffer));
}

CsvRow& CsvRow::operator<<(std::uint64_t number) { return *this << std::to_string(number); }

CsvRow& CsvRow::operator<<(std::string_view text) {
  separate();
  if (text.find_first_of(",\"") == std::string_view::npos) {
    text_ += text;
    return *this;
  }
  text_ += '"';
  for (const char c : text) text_.append(c == '"' ? 2 : 1, c);
  text_ += '"';
  return *this;
}

void CsvRow::separate() {
  if (!first_) text_ += ',';
  first_ = false;
}

}  // namespace hybrid_sphere::cli
