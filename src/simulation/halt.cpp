// How the computation stops.
#include <exception>
#include <new>
#include <sstream>
#include <utility>

#include "simulation/event_loop.hpp"

namespace hybrid_sphere {

void EventLoop::set_interrupt(std::function<bool()> should_stop) {
  if (!should_stop) {
    should_stop_ = nullptr;
    return;
  }
  should_stop_ = [ask = std::move(should_stop)] {
    try {
      return ask();
    } catch (...) {
      throw CallerException{std::current_exception()};
    }
  };
}

/// An exception during state evaluation is reported by the next advance_to; the state stays the last one
/// reported.
void EventLoop::give_up(const char* reason) {
  try {
    halt_.reason = HaltedError(Stop::numerical, outlook_.now, reason);
  } catch (const std::bad_alloc&) {
    halt_.reason = HaltedError(outlook_.now, halt_.out_of_memory);
  }
  report_.hold();
  schedule(outlook_.now);
}

const State& EventLoop::state() {
  if (report_.is_held()) return report_.state();
  try {
    report_.update(hybrid_.tau_at(outlook_.now));
    report_.state().time = outlook_.now;
  } catch (const std::exception& error) {
    give_up(error.what());
  }
  return report_.state();
}

Status EventLoop::status() const {
  if (halt_.reason) return {halt_.reason->stop(), halt_.reason->time(), halt_.reason->what()};
  if (halt_.interrupted_at == outlook_.now) return {Stop::interrupted, outlook_.now, Interrupted().what()};
  return {Stop::none, outlook_.now, ""};
}

Vector3d EventLoop::reaction() {
  if (report_.is_held()) return report_.reaction();
  if (hybrid_.segment.mode() == ContactMode::free) return {0, 0, hybrid_.segment.dynamics().normal_force};
  try {
    return report_.update_reaction();
  } catch (const std::exception& error) {
    give_up(error.what());
  }
  return report_.reaction();
}

void EventLoop::halt_in_livelock() {
  std::ostringstream reason;
  const Vector2d position = hybrid_.segment.at(hybrid_.tau_at(outlook_.now)).center.position;
  reason << "livelock at t = " << outlook_.now << " s, x = " << position.x() << " m, y = " << position.y()
         << " m: thrown endlessly from";
  for (const RegionId region : instant_.visited) reason << " \"" << hybrid_.ground->name(region) << "\" to";
  reason << " \"" << hybrid_.ground->name(instant_.visited.front()) << "\"; "
         << (hybrid_.ground->surface().livelock == scene::Livelock::stop
                 ? "surface.livelock is stop"
                 : "no motion along an edge between them is known");
  halt(Stop::livelock, reason.str());
}

/// The sphere is thrown back and forth in ever shorter times, endlessly in a finite time, with no motion
/// after it.
void EventLoop::halt_in_accumulation() {
  std::ostringstream reason;
  const Vector2d position = hybrid_.segment.at(hybrid_.tau_at(outlook_.now)).center.position;
  reason << "switches accumulate at t = " << outlook_.now << " s, x = " << position.x()
         << " m, y = " << position.y() << " m, last on \"" << hybrid_.ground->name(hybrid_.in_force.region)
         << "\", and no motion along the edge is known";
  halt(Stop::accumulation, reason.str());
}

void EventLoop::halt(Stop stop, const std::string& reason) {
  this->stop(HaltedError(stop, outlook_.now, reason));
}

void EventLoop::halt_without_memory() { stop(HaltedError(outlook_.now, halt_.out_of_memory)); }

/// The sphere stays put from here on; throws only the given error.
void EventLoop::stop(const HaltedError& reason) {
  halt_.reason = reason;
  report_.hold_at_present(instant_.arrival.state);
  report_.name_if_nameless();
  schedule(outlook_.now);
  throw HaltedError(*halt_.reason);
}

}  // namespace hybrid_sphere
