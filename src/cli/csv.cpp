#include "cli/csv.hpp"

#include "cli/csv_row.hpp"

namespace hybrid_sphere::cli {
namespace {

CsvRow& operator<<(CsvRow& row, const Vector2d& v) { return row << v.x() << v.y(); }
CsvRow& operator<<(CsvRow& row, const Vector3d& v) { return row << v.x() << v.y() << v.z(); }
CsvRow& operator<<(CsvRow& row, const Quaterniond& q) { return row << q.x() << q.y() << q.z() << q.w(); }
CsvRow& operator<<(CsvRow& row, const Twist& twist) {
  return row << twist.velocity << twist.angular_velocity;
}

}  // namespace

void append_row(const State& state, std::string& text) {
  CsvRow row(text);
  row << state.time << state.position << state.orientation << state.twist << std::uint64_t(state.stage)
      << to_string(state.mode) << state.region;
  row.end();
}

void append_row(const Switch& event, std::string& text) {
  CsvRow row(text);
  row << event.index << event.time << to_string(event.kind) << event.from_region << event.to_region
      << event.position << event.impulse << event.angular_impulse << event.before << event.after
      << event.energy_before << event.energy_after;
  row.end();
}

}  // namespace hybrid_sphere::cli
