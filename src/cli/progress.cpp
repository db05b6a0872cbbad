#include "cli/progress.hpp"

#include <algorithm>
#include <iomanip>
#include <ostream>
#include <sstream>
#include <string>

namespace hybrid_sphere::cli {

Progress::~Progress() { give_way(); }

void Progress::give_way() {
  if (shown_) err_ << '\n';
  shown_ = false;
}

void Progress::show(double done, double whole, const char* unit) {
  if (done_at_begin_ < 0) done_at_begin_ = done;
  if (silent_ || Clock::now() < next_) return;
  next_ = Clock::now() + std::chrono::milliseconds(200);
  shown_ = true;
  constexpr std::size_t width = 40;
  const double part = whole > 0 ? std::clamp(done / whole, 0.0, 1.0) : 1.0;
  const auto filled = static_cast<std::size_t>(part * width);
  err_ << "\r[" << std::string(filled, '#') << std::string(width - filled, ' ') << "] "
       << static_cast<int>(100 * part) << " %";
  const double rate = (done - done_at_begin_) / std::chrono::duration<double>(Clock::now() - begin_).count();
  if (*unit != 0 && rate > 0) {
    std::ostringstream text;
    text << std::setprecision(3) << ", " << rate << " " << unit << "/s, " << (whole - done) / rate
         << " s left";
    err_ << std::left << std::setw(static_cast<int>(width)) << text.str();
  }
  err_ << std::flush;
}

}  // namespace hybrid_sphere::cli
