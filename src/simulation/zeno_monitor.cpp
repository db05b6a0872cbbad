#include "simulation/zeno_monitor.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <utility>

#include "simulation/edge_line.hpp"

namespace hybrid_sphere {
namespace {

// A cycle of this many throws, 1/(1 - q), is passed there. The path to the limit leaves the edge by four
// times as many excursions as there are throws: a slower cycle has smaller ones before it is passed.
constexpr double few_throws = 0x1p+6;

/// Number of pieces of edge.
std::uint64_t edges_of(const scene::Surface& surface) {
  std::uint64_t edges = 0;
  for (const scene::Region& region : surface.regions) {
    const auto* polygon = std::get_if<scene::Polygon>(&region.shape);
    edges += polygon ? polygon->vertices.size() : 1;
  }
  return edges;
}

}  // namespace

void ZenoMonitor::begin(double now) {
  slow_.begin(now);
  standstill_.begin();
  detector_.clear();
  limit_.reset();
  comes_ = false;
  limit_passed_at_ = -1;
  rebound_.reset();
}

/// To be called after every many_instants instants.
bool ZenoMonitor::many_accumulate(double now) {
  const double since = slow_.counted_from();
  const scene::Solver& solver = hybrid_.segment.solver();
  // Within a fixed-length step the path is only a guess, which may cross one edge again and again.
  const double of_step = solver.has_fixed_step() ? 0x1p-30 * solver.step : 0;
  const double resolution = std::max(DBL_EPSILON * now, of_step);
  const bool unresolved = now - since <= SlowZenoDetector::many_instants * resolution;
  // A neck between two edges is a cusp until the sphere has come to its narrowest place.
  constexpr std::uint64_t least = 1 << 20;
  slow_.count_block(now);
  return unresolved || is_deep_in_cusp() ||
         (slow_.suspected() &&
          slow_.seen(std::max<std::uint64_t>(edges_of(hybrid_.ground->surface()), least / 8)));
}

void ZenoMonitor::note_arrival(const Arrival& arrival, RegionId entered, const SplitTime& instant,
                               const Contact& edge) {
  ZenoDetector::Arrival& next = detector_.next();
  next.left = hybrid_.in_force.region;
  next.entered = entered;
  next.time = instant.value;
  next.remainder = instant.remainder;
  next.position = arrival.state.position;
  next.twist = arrival.state.twist;
  next.contact = edge;
  next.unseen = 0;
  comes_ = true;
}

/// Whether two grounds whose edges touch throw the sphere at each other next to that place, and towards it.
bool ZenoMonitor::is_deep_in_cusp() const {
  constexpr double next_to = 7e-6;
  const ZenoDetector::Throws throws = detector_.throws_to_and_fro();
  if (!throws.last) return false;
  const scene::Shape& a = hybrid_.ground->shape(throws.last->contact.region);
  const scene::Shape& b = hybrid_.ground->shape(throws.other->contact.region);
  const double rounding = unseen * (size_of(a) + size_of(b));
  const auto touch = touch_of(a, throws.last->contact.piece, b, throws.other->contact.piece, rounding);
  if (!touch) return false;
  const double distance = (throws.last->position - touch->point).norm();
  return distance <= next_to * touch->radius && distance < (throws.before->position - touch->point).norm();
}

/// Whether the edges of the two grounds that throw the sphere back in turn meet in a corner.
bool ZenoMonitor::throws_meet_in_corner() const {
  const ZenoDetector::Throws throws = detector_.throws_to_and_fro();
  if (!throws.last) return false;
  const scene::Shape& a = hybrid_.ground->shape(throws.last->contact.region);
  const scene::Shape& b = hybrid_.ground->shape(throws.other->contact.region);
  const double rounding = unseen * (size_of(a) + size_of(b));
  return corner_of(a, throws.last->contact.piece, b, throws.other->contact.piece, rounding).has_value();
}

/// Longest excursion from an edge that the search for the return does not see [s].
double ZenoMonitor::unseen_excursion(const ZenoDetector::Arrival& arrival, double tau) {
  if (arrival.contact.region == no_region) return 0;
  const scene::Shape& shape = hybrid_.ground->shape(arrival.contact.region);
  const std::optional<LocalEdge> edge = local_edge(shape, arrival.contact.piece, arrival.position);
  const PointState now = hybrid_.segment.at(tau).center;
  double acceleration = now.acceleration.norm();  // from a corner
  if (edge) {
    const double along = now.velocity.dot(turned(edge->normal));
    acceleration = std::abs(now.acceleration.dot(edge->normal) + edge->bend * along * along);
  }
  const double size = arrival.position.norm() + size_of(shape);
  return acceleration > 0 ? 8 * std::sqrt(unseen * size / acceleration) : 0;
}

bool ZenoMonitor::check(const Arrival& arrival, const Contacts& contacts, double now) {
  if (!std::exchange(comes_, false)) return true;
  ZenoDetector::Arrival& last = detector_.next();
  last.reached = hybrid_.in_force.region;
  last.struck = rebound_.has_value();
  if (arrival.complete) {  // at an end of a side the corner is known
    for (const Contact& contact : contacts) {
      if (contact.region == last.left || contact.region == last.entered) last.contact = contact;
    }
  }
  if (!hybrid_.segment.uniform() && !last.struck) last.unseen = unseen_excursion(last, arrival.tau);
  detector_.add();
  const double scale = hybrid_.segment.time_scale();
  const bool chatters = detector_.chatters(scale, hybrid_.segment.motion().is_integrated()) &&
                        (!detector_.throws_in_turn() || throws_meet_in_corner());
  if (chatters || detector_.stands(scale)) return false;
  if (!rebound_ || hybrid_.in_force.partner != no_region || limit_) return true;
  const auto cycle = detector_.cycle();
  return !cycle || find_limit(*cycle, now);
}

/// If an accumulation is near enough to its end, finds the limit. @return false if there is none
bool ZenoMonitor::find_limit(const ZenoDetector::Cycle& cycle, double now) {
  const ZenoDetector::Arrival& last = *cycle.last;
  if (last.contact.region == no_region) return true;
  const double size = last.position.norm() + size_of(hybrid_.ground->shape(last.contact.region));
  const std::optional<LocalEdge> edge =
      local_edge(hybrid_.ground->shape(last.contact.region), last.contact.piece, last.position);
  if (!edge) return true;
  const double across = speed_across(cycle, edge->normal);
  const double excursion = across * cycle.ratio * (cycle.ratio * cycle.interval) / 4;  // of the next cycle
  const bool unresolved = cycle.remaining <= 0.5 * DBL_EPSILON * now;
  const double small = unseen * size * std::min(1.0, few_throws * (1 - cycle.ratio));
  if (!unresolved && !(excursion <= small)) return true;
  if (cycle.length == 1) {
    find_limit_on_edge(last.contact, last.position);
    // Otherwise rounding made the intervals look like a series, and the throws go on.
    const bool agrees = limit_ && time_to_limit() <= 4 * cycle.remaining;
    if (limit_ && !agrees && !unresolved) {
      limit_.reset();
      return true;
    }
  } else if (cycle.length == 2 && cycle.opposite->struck) {
    find_limit_in_corner(cycle);
  }
  return limit_.has_value() || !cycle.is_steady;
}

/// Speed with which the sphere comes away from the edges of a cycle [m/s]. A narrow wedge is hidden by errors
/// of the path before a wide one; a straight path has none.
double ZenoMonitor::speed_across(const ZenoDetector::Cycle& cycle, const Vector2d& normal) const {
  const Vector2d& velocity = rebound_->velocity;
  if (cycle.length == 1) return std::abs(velocity.dot(normal));
  const Contact& other = cycle.opposite->contact;
  const bool is_wedge = cycle.length == 2 && !hybrid_.segment.uniform() && other.region != no_region;
  if (!is_wedge) return velocity.norm();
  const auto edge = local_edge(hybrid_.ground->shape(other.region), other.piece, cycle.opposite->position);
  if (!edge) return velocity.norm();
  return std::max(std::abs(velocity.dot(normal)), std::abs(cycle.last->twist.velocity.dot(edge->normal)));
}

ZenoMonitor::Throws ZenoMonitor::end_throws(const std::vector<RegionId>& visited,
                                            const EdgeContacts& contacts, const Vector2d& position,
                                            double now) {
  const auto sets_it = [this](RegionId region) { return sets_velocity(hybrid_.ground->material(region)); };
  if (!rebound_ || limit_passed_at_ == now || std::count_if(visited.begin(), visited.end(), sets_it) != 1)
    return Throws::go_on;
  for (const Contact& contact : contacts.all()) {
    const bool between = std::find(visited.begin(), visited.end(), contact.region) != visited.end();
    if (!between || contact.piece.kind == EdgePiece::Kind::vertex) continue;
    find_limit_on_edge(contact, position);
    if (limit_ && leaves_edge_before_limit(contact, position)) {
      limit_.reset();
      return Throws::halt;
    }
    return limit_ ? Throws::end : Throws::go_on;
  }
  return Throws::go_on;
}

/// Whether the motion of the last throw would lead away from the edge until the limit: as many throws are
/// still to come, each within rounding.
bool ZenoMonitor::leaves_edge_before_limit(const Contact& contact, const Vector2d& position) {
  constexpr double many = 0x1p+12;
  const scene::Shape& shape = hybrid_.ground->shape(contact.region);
  const Vector2d normal = local_edge(shape, contact.piece, position)->normal;
  const PointState center = hybrid_.segment.at(0).center;
  const double left = time_to_limit();
  const double away =
      (std::abs(center.velocity.dot(normal)) + 0.5 * left * std::abs(center.acceleration.dot(normal))) * left;
  return away > many * unseen * (position.norm() + size_of(shape));
}

/// One ground throws the sphere back at ever smaller speeds, until it no longer does.
void ZenoMonitor::find_limit_on_edge(const Contact& contact, const Vector2d& position) {
  LocalEdge edge = *local_edge(hybrid_.ground->shape(contact.region), contact.piece, position);
  if (contact.region != rebound_->from) edge = {-edge.normal, -edge.bend};
  // On that ground the speed across the edge is p_c.n + kappa u.n, also where the sphere is not on it.
  const double along = rebound_->velocity.dot(turned(edge.normal));
  const double speed = rebound_->velocity.dot(edge.normal);
  const double push = rebound_->acceleration.dot(edge.normal) + edge.bend * along * along;
  if (!(push > 0)) return;
  const double left = last_throw(contact, edge.normal, std::max(0.0, -speed / push));
  limit_ = {hybrid_.epoch.plus(left), Vector2d::Zero(), rebound_->from, no_region, contact};
}

Vector2d ZenoMonitor::conserved_after(double tau) {
  const auto conserved = [this](double time) {
    const MotionState state = hybrid_.segment.at(time);
    return hybrid_.sphere.conserved_velocity({state.center.velocity, state.angular_velocity});
  };
  const double next = std::min(tau, expected());
  if (!(next > 0) || !resists_rolling(hybrid_.segment.dynamics(), hybrid_.segment.material()))
    return conserved(tau);
  const Vector2d begin = conserved(0);
  return begin + tau / next * (conserved(next) - begin);
}

/// When the speed across the edge that the throwing ground would give reaches 0 on the present path of the
/// sphere: p_c need not change here as it would on that ground.
/// @param normal  of the edge at the last throw, into the ground that throws
/// @param guess   since the beginning of the segment [s]
double ZenoMonitor::last_throw(const Contact& contact, const Vector2d& normal, double guess) {
  const scene::Shape& shape = hybrid_.ground->shape(contact.region);
  const scene::Material& ground = hybrid_.ground->material(rebound_->from);
  const auto across = [&](double tau) {
    hybrid_.segment.reach(tau);
    const MotionState now = hybrid_.segment.at(tau);
    Vector2d here = local_edge(shape, contact.piece, now.center.position)->normal;
    if (here.dot(normal) < 0) here = -here;
    return (conserved_after(tau) + hybrid_.sphere.kappa() * ground_velocity(ground, now.center.position))
        .dot(here);
  };
  // A guess later than the time in which the forces change the motion is useless, yet would be followed
  // unchecked.
  constexpr double many = 16;
  constexpr double many_steps = 1024;
  const scene::Solver& solver = hybrid_.segment.solver();
  const double steps = solver.has_fixed_step() ? many_steps * solver.step : never;
  if (guess > std::min(many * hybrid_.segment.time_scale(), steps)) return guess;
  // A resistance of the other ground may slow down what the throws use up.
  const double limit = 1024 * guess;
  double before = 0;
  double at_before = across(0);
  for (int i = 0; i < 3 && guess != before; ++i) {
    const double at_guess = across(guess);
    const double next = guess - at_guess * (guess - before) / (at_guess - at_before);
    if (!(next >= 0 && next <= limit)) break;
    before = std::exchange(guess, next);
    at_before = at_guess;
  }
  return guess;
}

void ZenoMonitor::find_limit_in_corner(const ZenoDetector::Cycle& cycle) {
  const ZenoDetector::Arrival& last = *cycle.last;
  const ZenoDetector::Arrival& other = *cycle.opposite;
  if (other.contact.region == no_region || other.entered == last.entered) return;
  const scene::Shape& a = hybrid_.ground->shape(last.contact.region);
  const scene::Shape& b = hybrid_.ground->shape(other.contact.region);
  const double rounding = unseen * (size_of(a) + size_of(b));
  const auto corner = corner_of(a, last.contact.piece, b, other.contact.piece, rounding);
  if (corner && !cycle.is_steady) {
    const bool is_met =
        holds(a, last.contact.piece, *corner, rounding) && holds(b, other.contact.piece, *corner, rounding);
    if (!is_met || !detector_.shrinks_towards(*corner, cycle.ratio, rounding)) return;
  }
  const double way = (last.position - other.position).norm();
  if (!corner || !((*corner - cycle.limit).norm() <= way + rounding)) return;
  limit_ = {hybrid_.epoch.plus(cycle.remaining), *corner, last.entered, other.entered};
}

}  // namespace hybrid_sphere
