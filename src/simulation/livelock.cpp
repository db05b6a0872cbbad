// Grounds that throw the sphere at each other endlessly: the slide along the edge between them
// (docs/theory.md 5.4), and what comes after the last instant of an accumulation (5.5).
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "simulation/edge_line.hpp"
#include "simulation/event_loop.hpp"
#include "sphere/unit_quaternion.hpp"

namespace hybrid_sphere {

using scene::Law;

/// Two or more grounds throw the sphere at each other endlessly: docs/theory.md 5.4.
/// @param again  the ground that would be entered a second time
void EventLoop::resolve_livelock(RegionId again, const SwitchSink& on_switch) {
  const auto first = std::find(instant_.visited.begin(), instant_.visited.end(), again);
  instant_.visited.erase(instant_.visited.begin(), first);
  switch (
      zeno_.end_throws(instant_.visited, instant_.contacts, instant_.arrival.state.position, outlook_.now)) {
    case ZenoMonitor::Throws::end: return;
    case ZenoMonitor::Throws::halt: halt_in_accumulation();
    case ZenoMonitor::Throws::go_on: break;
  }
  if (hybrid_.ground->surface().livelock == scene::Livelock::slide && instant_.visited.size() == 2) {
    complete(instant_.arrival);
    // If the sphere was placed there, no path led there that could tell.
    EdgeContacts& contacts = instant_.contacts;
    const Segment::Start& state = instant_.arrival.state;
    const RegionId from = instant_.visited[0];
    const RegionId to = instant_.visited[1];
    contacts.add_seen_at(state.position);
    const std::optional<SharedEdge> edge = contacts.in_corner()
                                               ? contacts.edge_ahead(from, to, hybrid_.sphere, state)
                                               : contacts.edge_between(from, to, state.position);
    if (edge && edge->piece.piece.kind == EdgePiece::Kind::line &&
        slide_along_edge(*edge, instant_.arrival, on_switch))
      return;
  }
  if (!end_hidden_throws(on_switch)) halt_in_livelock();
}

/// The throws have become so small that rounding hides them: the sphere is on the edge, and goes on over the
/// ground that draws it in, if one does. docs/theory.md 5.5.
bool EventLoop::end_hidden_throws(const SwitchSink& on_switch) {
  if (instant_.visited.size() != 2 || instant_.drawn_in_at == outlook_.now) return false;
  complete(instant_.arrival);
  EdgeContacts& contacts = instant_.contacts;
  const Segment::Start& state = instant_.arrival.state;
  contacts.add_seen_at(state.position);
  const auto edge = contacts.in_corner()
                        ? std::nullopt
                        : contacts.edge_between(instant_.visited[0], instant_.visited[1], state.position);
  if (!edge) return false;
  for (const RegionId region : {edge->first, edge->second}) {
    const auto drawn = hybrid_.rules().drawn_in(hybrid_.ground->material(region), edge->seen_from(region),
                                                state, speed_of_hidden_throws(*edge));
    if (!drawn) continue;
    go_on_from_edge(region, *drawn, on_switch);
    return true;
  }
  return false;
}

/// With which a throw off an edge stays within rounding of it [m/s]; 0 where no friction ends throws.
double EventLoop::speed_of_hidden_throws(const SharedEdge& edge) const {
  constexpr double most = 0x1p-20;  // of the speeds so far
  const Segment::Start& state = instant_.arrival.state;
  double pull = 0;
  bool has_friction = false;
  for (const RegionId region : {edge.first, edge.second}) {
    const scene::Material& ground = hybrid_.ground->material(region);
    has_friction = has_friction || ground.law == Law::coulomb;
    const double across = hybrid_.rules().acceleration_on(ground, state).dot(edge.normal);
    pull = std::max(pull, std::abs(across + edge.bend * state.twist.velocity.squaredNorm()));
  }
  if (!has_friction) return 0;
  const double by_place = std::sqrt(2 * pull * unseen * state.position.norm());
  const scene::Solver& solver = hybrid_.segment.solver();
  const double by_error = solver.has_fixed_step() ? 0 : solver.accuracy * hybrid_.fastest;
  return std::max(16 * hybrid_.rounding_of_speeds(),
                  std::min(std::max(by_place, by_error), most * hybrid_.fastest));
}

/// @param state  on an edge of the ground, at this instant
void EventLoop::go_on_from_edge(RegionId region, const Segment::Start& state, const SwitchSink& on_switch) {
  const scene::Material& ground = hybrid_.ground->material(region);
  const Vector2d u = ground_velocity(ground, state.position);
  const Vector2d nu = state.twist.velocity - state.contact_velocity;
  const ContactMode mode = contact_mode_on(hybrid_.segment.dynamics(), ground, state.position,
                                           state.twist.velocity, state.contact_velocity - u, nu);
  Arrival& arrival = instant_.arrival;
  const Segment::Start before = std::exchange(arrival.state, state);
  Switch event;
  event.before = before.twist;
  const SplitTime instant = hybrid_.epoch.plus(arrival.tau, arrival.tau_remainder);
  event.time = instant.value;
  event.time_remainder = instant.remainder;
  event.slip_before = before.contact_velocity - u;
  event.impulse = hybrid_.sphere.mass() * (state.twist.velocity - before.twist.velocity);
  // Of what rounding hides: it need not act at the contact.
  const double k = hybrid_.sphere.gyration_radius();
  event.angular_impulse =
      hybrid_.sphere.mass() * k * k * (state.twist.angular_velocity - before.twist.angular_velocity);
  try {
    begin_segment(instant, mode, ground, arrival.state);
  } catch (...) {
    arrival.state = before;
    report_.stand(before);
    throw;
  }
  instant_.drawn_in_at = outlook_.now;
  instant_.visited = {region};
  instant_.jumped = false;
  instant_.stays = true;
  instant_.ahead = Ahead::to_throw;
  arrival.tau = arrival.tau_remainder = 0;
  arrival.mode.reset();
  commit_transition(region, constraint_of(mode, ground), arrival, event, on_switch);
}

bool EventLoop::slide_along_edge(const SharedEdge& edge, Arrival& arrival, const SwitchSink& on_switch) {
  const Dynamics& dynamics = hybrid_.segment.dynamics();
  const scene::Material& a = hybrid_.ground->material(edge.first);
  const scene::Material& b = hybrid_.ground->material(edge.second);
  const auto is_plain = [](const scene::Material& material) {
    return material.law == Law::rough && material.turntable_rate == 0 && material.rolling_resistance == 0 &&
           material.spin_friction == 0;
  };
  const bool drifts = dynamics.has_drag() || dynamics.quadratic_drag != 0 || dynamics.spring_rate != 0;
  if (!is_plain(a) || !is_plain(b) || drifts || !((a.belt - b.belt).dot(edge.normal) < 0)) return false;
  Segment::Start& state = arrival.state;
  const Segment::Start before = state;
  Switch event;
  event.before = state.twist;
  const SplitTime instant = hybrid_.epoch.plus(arrival.tau, arrival.tau_remainder);
  event.time = instant.value;
  event.time_remainder = instant.remainder;
  EdgeSlide slide(dynamics, a.belt, b.belt, edge.normal, state.position,
                  hybrid_.sphere.conserved_velocity(state.twist),
                  NormalSpin(state.twist.angular_velocity.z(), dynamics.normal_spin, 0, 0, 0));
  const MotionState after = slide.at(0);
  event.slip_before = state.contact_velocity - a.belt;
  event.impulse = hybrid_.sphere.mass() * (after.center.velocity - state.twist.velocity);
  event.angular_impulse = hybrid_.sphere.angular_impulse(event.impulse);
  state.twist = {after.center.velocity, after.angular_velocity};
  state.contact_velocity = after.contact_velocity;
  instant_.contacts.follow(edge);
  hybrid_.epoch = instant;
  try {
    hybrid_.segment.begin_edge_slide(slide, state);
    report_.follow_segment();
  } catch (...) {
    report_.stand(before);
    throw;
  }
  instant_.ahead = Ahead::to_slide;
  arrival.tau = arrival.tau_remainder = 0;
  if (arrival.cause != Cause::accumulation) arrival.cause = Cause::livelock;
  instant_.arrival = arrival;
  hybrid_.in_force.edge = edge;
  commit_transition(edge.first, constraint_of(ContactMode::edge_sliding, a), instant_.arrival, event,
                    on_switch, edge.second);
  return true;
}

/// The last instant of an accumulation: from then on the sphere moves as usual.
void EventLoop::pass_limit(const SwitchSink& on_switch) {
  edge_events_.pass_without_crossing();
  zeno_.pass_limit(outlook_.now);
  const double tau = std::max(0.0, hybrid_.epoch.until(next_.value) + next_.remainder);
  const MotionState now = hybrid_.segment.told_at(tau);
  Arrival arrival = arrive(tau, now, now.center.position, Cause::accumulation);
  arrival.restarts = arrival.complete = true;
  arrival.state.orientation = to_unit(hybrid_.segment.orientation(tau));
  // The limit counts as passed whatever a sink throws.
  const struct Passed {
    std::optional<ZenoLimit>& limit;
    ~Passed() { limit.reset(); }
  } passed{zeno_.limit()};
  ZenoLimit& limit = *zeno_.limit();
  if (limit.other != no_region) {
    pass_corner(arrival, on_switch);
    return;
  }
  if (resists_rolling(hybrid_.segment.dynamics(), hybrid_.segment.material())) {
    Twist& twist = arrival.state.twist;
    const Vector2d missed = (zeno_.conserved_after(tau) - hybrid_.sphere.conserved_velocity(twist)) /
                            (1 - hybrid_.sphere.kappa());
    twist.velocity += missed;
    arrival.state.contact_velocity += missed;
  }
  const scene::Shape& shape = hybrid_.ground->shape(limit.edge.region);
  Vector2d& position = arrival.state.position;
  position = put_on_edge(shape, limit.edge.piece, position);
  limit.normal = local_edge(shape, limit.edge.piece, position)->normal;
  if (limit.ground != limit.edge.region) limit.normal = -limit.normal;
  enter_ground(limit.ground, arrival, on_switch);
}

/// Two grounds throw the sphere at each other in a corner: it follows the edge between them, if one continues
/// from there.
void EventLoop::pass_corner(Arrival& arrival, const SwitchSink& on_switch) {
  const ZenoLimit& limit = *zeno_.limit();
  const RegionId first = limit.ground;
  const RegionId second = limit.other;
  arrival.state.position = limit.position;
  instant_.visited = {first, second};
  EdgeContacts& contacts = instant_.contacts;
  contacts.add_pieces_seen_at(limit.position);
  const std::optional<SharedEdge> ahead = contacts.edge_ahead(first, second, hybrid_.sphere, arrival.state);
  const bool slides = hybrid_.ground->surface().livelock == scene::Livelock::slide;
  if (ahead && !slides) halt_in_livelock();
  if (!ahead) halt_in_accumulation();
  // Of a region's contacts the first one is the edge, and the last one what a straight path starts on.
  const Contacts crossed = contacts.exchange(ahead->piece);
  for (const RegionId region : {first, second}) contacts.add_corner(region, limit.position);
  for (const Contact& contact : crossed) contacts.add_corner(contact.region, limit.position);
  if (!slide_along_edge(*ahead, arrival, on_switch)) halt_in_accumulation();
}

}  // namespace hybrid_sphere
