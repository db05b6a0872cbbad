#include "cli/progress.hpp"

#include <algorithm>
#include <ostream>
#include <string>

namespace hybrid_sphere::cli {

Progress::~Progress() { give_way(); }

void Progress::give_way() {
  if (shown_) err_ << '\n';
  shown_ = false;
}

void Progress::show(double done, double whole) {
  if (silent_ || Clock::now() < next_) return;
  next_ = Clock::now() + std::chrono::milliseconds(200);
  shown_ = true;
  constexpr std::size_t width = 40;
  const double part = whole > 0 ? std::clamp(done / whole, 0.0, 1.0) : 1.0;
  const auto filled = static_cast<std::size_t>(part * width);
  err_ << "\r[" << std::string(filled, '#') << std::string(width - filled, ' ') << "] "
       << static_cast<int>(100 * part) << " %" << std::flush;
}

}  // namespace hybrid_sphere::cli
