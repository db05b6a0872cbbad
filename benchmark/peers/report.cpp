#include "report.hpp"

#include <algorithm>
#include <cfloat>
#include <cstdio>
#include <ostream>
#include <string>

namespace hybrid_sphere::peers {
namespace {

constexpr double wanted_speed = 10;
constexpr double wanted_accuracy = 1000;
constexpr double rounding = DBL_EPSILON / 2;  // an error below it is none

std::string formatted(const char* format, double value) {
  if (!std::isfinite(value)) return "";
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string padded(std::string text, std::size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

std::string quoted(const std::string& text) {
  std::string quoted;
  for (const char c : text) {
    if (c == '"') quoted += c;
    quoted += c == '\n' ? ' ' : c;
  }
  return '"' + quoted + '"';
}

/// The rows of one peer in one scene, and the row of hybrid_sphere for the same outputs.
struct Duel {
  Row own;
  std::vector<Row> rows;
};

std::vector<Duel> duels(const std::vector<Row>& rows) {
  std::vector<Duel> duels;
  Row own;
  for (const Row& row : rows) {
    if (!std::isfinite(row.ratio)) {
      if (row.simulator == rows.front().simulator && row.scene != own.scene) own = row;
      continue;
    }
    if (!row.ran()) continue;
    const bool next = duels.empty() || duels.back().rows.front().scene != row.scene ||
                      duels.back().rows.front().simulator != row.simulator;
    if (next) duels.push_back({own, {}});
    duels.back().rows.push_back(row);
  }
  return duels;
}

/// @return  whether both hold
bool write_duel(const Duel& duel, std::ostream& out) {
  const auto& rows = duel.rows;
  const auto& best = *std::min_element(rows.begin(), rows.end(),
                                       [](const Row& a, const Row& b) { return a.error() < b.error(); });
  const auto& cheapest =
      *std::min_element(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.cost < b.cost; });
  const double own_error = std::max(duel.own.error(), rounding);
  const bool as_accurate = own_error <= std::max(best.error(), rounding);
  const bool as_cheap = duel.own.cost <= cheapest.cost;
  const double more_accurate = cheapest.error() / own_error;
  const double least = std::max(best.error(), rounding) / own_error;
  const bool fast = as_accurate && best.ratio >= wanted_speed;
  const bool accurate = as_cheap && more_accurate >= wanted_accuracy;
  out << padded(best.scene, 13) << padded(best.simulator, 14) << padded(formatted("%.1e", best.error()), 9)
      << padded(formatted("%.3gx", best.ratio), 11)
      << padded(fast ? "yes" : (as_accurate ? "NO: slower" : "NO: less accurate"), 19)
      << padded(formatted("%.1e", cheapest.error()), 9) << padded(formatted("%.3gx", cheapest.ratio), 10)
      << padded(formatted("%.2gx", more_accurate), 11)
      << padded(accurate ? "yes" : (as_cheap ? "NO: as accurate" : "NO: cheaper"), 17)
      << formatted("%.2gx", least) << '\n';
  return fast && accurate;
}

}  // namespace

void write_csv(const std::vector<Row>& rows, std::ostream& out) {
  out << "scene,simulator,step,position_error,velocity_error,ns_per_simulated_second,"
         "ratio_to_hybrid_sphere,ratio_at_every_step,note\n";
  for (const Row& row : rows) {
    out << row.scene << ',' << row.simulator << ',' << formatted("%g", row.dial) << ','
        << formatted("%.3e", row.position_error) << ',' << formatted("%.3e", row.velocity_error) << ','
        << formatted("%.4g", row.cost) << ',' << formatted("%.3g", row.ratio) << ','
        << formatted("%.3g", row.step_ratio) << ',' << (row.note.empty() ? "" : quoted(row.note)) << '\n';
  }
}

void write_table(const std::vector<Row>& rows, std::ostream& out) {
  out << padded("scene", 13) << padded("simulator", 14) << padded("step", 8) << padded("position", 10)
      << padded("velocity", 10) << padded("ns/s", 10) << padded("ratio", 10) << padded("each step", 10)
      << "note\n";
  for (const Row& row : rows) {
    out << padded(row.scene, 13) << padded(row.simulator, 14) << padded(formatted("%g", row.dial), 8)
        << padded(formatted("%.1e", row.position_error), 10)
        << padded(formatted("%.1e", row.velocity_error), 10) << padded(formatted("%.2e", row.cost), 10)
        << padded(formatted("%.3g", row.ratio), 10) << padded(formatted("%.3g", row.step_ratio), 10)
        << row.note << '\n';
  }
}

void write_claim(const std::vector<Row>& rows, std::ostream& out) {
  out << "\nhybrid_sphere beside each peer. 1: how many times faster than the peer's most accurate row, "
         "wanted 10."
      << "\n2: how many times more accurate than its cheapest row, wanted 1000; below rounding counts as "
         "rounding."
      << "\nLast: how many times more accurate than its most accurate row.\n"
      << padded("scene", 13) << padded("peer", 14) << padded("error", 9) << padded("faster", 11)
      << padded("claim 1", 19) << padded("error", 9) << padded("cheaper", 10) << padded("accurate", 11)
      << padded("claim 2", 17) << "than best\n";
  int held = 0;
  const std::vector<Duel> all = duels(rows);
  for (const Duel& duel : all) held += write_duel(duel, out) ? 1 : 0;
  out << "both hold in " << held << " of " << all.size() << '\n';
}

}  // namespace hybrid_sphere::peers
