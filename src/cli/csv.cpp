#include "hybrid_sphere/cli/csv.hpp"

#include <charconv>
#include <string_view>

namespace hybrid_sphere::cli {
namespace {

class Row {
 public:
  explicit Row(std::string& text) : text_(text) {}

  Row& operator<<(double number) {
    char buffer[32];
    const auto end =
        std::to_chars(buffer, buffer + sizeof buffer, number, std::chars_format::general, 17).ptr;
    return *this << std::string_view(buffer, static_cast<std::size_t>(end - buffer));
  }

  Row& operator<<(std::uint64_t number) { return *this << std::string_view(std::to_string(number)); }

  /// RFC 4180: quoted where the text itself has a comma or a quote.
  Row& operator<<(std::string_view text) {
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

  Row& operator<<(const char* text) { return *this << std::string_view(text); }
  Row& operator<<(const Vector2d& v) { return *this << v.x() << v.y(); }
  Row& operator<<(const Vector3d& v) { return *this << v.x() << v.y() << v.z(); }
  Row& operator<<(const Quaterniond& q) { return *this << q.x() << q.y() << q.z() << q.w(); }
  Row& operator<<(const Twist& twist) { return *this << twist.velocity << twist.angular_velocity; }

  void end() { text_ += '\n'; }

 private:
  void separate() {
    if (!first_) text_ += ',';
    first_ = false;
  }

  std::string& text_;
  bool first_ = true;
};

}  // namespace

void append_row(const State& state, std::string& text) {
  Row row(text);
  row << state.time << state.position << state.orientation << state.twist << std::uint64_t(state.stage)
      << to_string(state.mode) << state.region;
  row.end();
}

void append_row(const Switch& event, std::string& text) {
  Row row(text);
  row << event.index << event.time << to_string(event.kind) << event.from_region << event.to_region
      << event.position << event.impulse << event.angular_impulse << event.before << event.after
      << event.energy_before << event.energy_after;
  row.end();
}

}  // namespace hybrid_sphere::cli
