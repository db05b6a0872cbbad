// Where switches accumulate: the last instant of throws to and fro, and what comes after it. Rules:
// docs/theory.md 5.5.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <sstream>
#include <utility>

#include "edge_line.hpp"
#include "hybrid_sphere/simulation/simulation.hpp"

namespace hybrid_sphere {
namespace {

using scene::Circle;
using scene::HalfPlane;
using scene::Polygon;

// An excursion from an edge of so many roundings of the place is not seen by the search for the return: it
// begins 8 sqrt(noise/acceleration) after the start, with 4 roundings in the noise (trace_curve.cpp).
constexpr double unseen = 64 * DBL_EPSILON;
// A cycle of so many throws, 1/(1 - q), is passed there. The path to the limit comes off the edge by four
// times as many excursions as there are throws: a slower cycle has smaller ones before it is passed.
constexpr double few_throws = 0x1p+6;

/// Number of pieces of edge.
std::uint64_t edges_of(const scene::Surface& surface) {
  std::uint64_t edges = 0;
  for (const scene::Region& region : surface.regions) {
    const auto* polygon = std::get_if<Polygon>(&region.shape);
    edges += polygon ? polygon->vertices.size() : 1;
  }
  return edges;
}

}  // namespace

void Simulation::pass_many_instants() {
  const double since = slow_zeno_.counted_from();
  const scene::Solver& solver = segment_.solver();
  // Within a step of a fixed length the path is a guess, which may lead over one edge again and again.
  const double of_step = solver.has_fixed_step() ? 0x1p-30 * solver.step : 0;
  const double resolution = std::max(DBL_EPSILON * now_, of_step);
  const bool unresolved = now_ - since <= SlowZenoDetector::many_instants * resolution;
  // A neck between two edges is a cusp until the sphere has come to its narrowest place.
  constexpr std::uint64_t least = 1 << 20;
  slow_zeno_.count_block(now_);
  if (unresolved || is_deep_in_cusp() ||
      (slow_zeno_.suspected() &&
       slow_zeno_.seen(std::max<std::uint64_t>(edges_of(ground_->surface()), least / 8)))) {
    halt_in_accumulation();
  }
}

/// Whether two grounds whose edges touch throw the sphere at each other next to that place, and towards it.
bool Simulation::is_deep_in_cusp() const {
  constexpr double next_to = 7e-6;
  const ZenoDetector::Throws throws = zeno_.throws_to_and_fro();
  if (!throws.last) return false;
  const scene::Shape& a = ground_->shape(throws.last->contact.region);
  const scene::Shape& b = ground_->shape(throws.other->contact.region);
  const double rounding = unseen * (size_of(a) + size_of(b));
  const auto touch = touch_of(a, throws.last->contact.piece, b, throws.other->contact.piece, rounding);
  if (!touch) return false;
  const double distance = (throws.last->position - touch->point).norm();
  return distance <= next_to * touch->radius && distance < (throws.before->position - touch->point).norm();
}

/// Whether the edges of the two grounds that throw the sphere back in turn meet in a corner.
bool Simulation::throws_meet_in_corner() const {
  const ZenoDetector::Throws throws = zeno_.throws_to_and_fro();
  if (!throws.last) return false;
  const scene::Shape& a = ground_->shape(throws.last->contact.region);
  const scene::Shape& b = ground_->shape(throws.other->contact.region);
  const double rounding = unseen * (size_of(a) + size_of(b));
  return corner_of(a, throws.last->contact.piece, b, throws.other->contact.piece, rounding).has_value();
}

/// How long an excursion from an edge takes, at most, that the search for its return does not see [s].
double Simulation::unseen_excursion(const ZenoDetector::Arrival& arrival) {
  if (arrival.contact.region == no_region) return 0;
  const scene::Shape& shape = ground_->shape(arrival.contact.region);
  const std::optional<LocalEdge> edge = local_edge(shape, arrival.contact.piece, arrival.position);
  const PointState now = segment_.at(arrival_.tau).center;
  double acceleration = now.acceleration.norm();  // from a corner
  if (edge) {
    const double along = now.velocity.dot(turned(edge->normal));
    acceleration = std::abs(now.acceleration.dot(edge->normal) + edge->bend * along * along);
  }
  const double size = arrival.position.norm() + size_of(shape);
  return acceleration > 0 ? 8 * std::sqrt(unseen * size / acceleration) : 0;
}

/// After an instant at which the sphere came to an edge.
void Simulation::monitor_zeno() {
  if (!std::exchange(comes_, false)) return;
  ZenoDetector::Arrival& arrival = zeno_.next();
  arrival.reached = region_;
  arrival.struck = thrown_.has_value();
  if (arrival_.complete) {  // at an end of a side the corner is known
    for (const Contact& contact : contacts_) {
      if (contact.region == arrival.left || contact.region == arrival.entered) arrival.contact = contact;
    }
  }
  if (!segment_.uniform() && !arrival.struck) arrival.unseen = unseen_excursion(arrival);
  zeno_.add();
  const double scale = segment_.time_scale();
  const bool chatters = zeno_.chatters(scale) && (!zeno_.throws_in_turn() || throws_meet_in_corner());
  if (chatters || zeno_.stands(scale)) halt_in_accumulation();
  if (!thrown_ || partner_ != no_region || limit_) return;
  if (const auto cycle = zeno_.cycle()) find_limit(*cycle);
}

/// Whether an accumulation is near enough to its end, and where that is.
void Simulation::find_limit(const ZenoDetector::Cycle& cycle) {
  const ZenoDetector::Arrival& last = *cycle.last;
  if (last.contact.region == no_region) return;
  const double size = last.position.norm() + size_of(ground_->shape(last.contact.region));
  const std::optional<LocalEdge> edge =
      local_edge(ground_->shape(last.contact.region), last.contact.piece, last.position);
  if (!edge) return;
  const double across =
      cycle.length == 1 ? std::abs(thrown_->velocity.dot(edge->normal)) : thrown_->velocity.norm();
  const double excursion = across * cycle.ratio * (cycle.ratio * cycle.interval) / 4;  // of the next cycle
  const bool unresolved = cycle.remaining <= 0.5 * DBL_EPSILON * now_;
  const double small = unseen * size * std::min(1.0, few_throws * (1 - cycle.ratio));
  if (!unresolved && !(excursion <= small)) return;
  if (cycle.length == 1) {
    find_limit_on_edge(last.contact, last.position);
    // Intervals that rounding has made look like a series: the throws go on.
    const bool agrees =
        limit_ && epoch_.until(limit_->time.value) + limit_->time.remainder <= 4 * cycle.remaining;
    if (limit_ && !agrees && !unresolved) {
      limit_.reset();
      return;
    }
  } else if (cycle.length == 2 && cycle.opposite->struck) {
    find_limit_in_corner(cycle);
  }
  if (!limit_) halt_in_accumulation();
}

/// Where a ground that throws the sphere back would be entered again at once, as far as rounding tells,
/// though no other ground gives it a velocity: the last throws of an accumulation. Halts where they are not.
bool Simulation::ends_throws(const Vector2d& position) {
  const auto sets_it = [this](RegionId region) { return strikes(region); };
  if (!thrown_ || limit_passed_at_ == now_ || std::count_if(visited_.begin(), visited_.end(), sets_it) != 1)
    return false;
  for (const Contact& contact : contacts_) {
    const bool between = std::find(visited_.begin(), visited_.end(), contact.region) != visited_.end();
    if (!between || contact.piece.kind == EdgePiece::Kind::vertex) continue;
    find_limit_on_edge(contact, position);
    if (limit_ && leaves_edge_before_limit(contact, position)) {
      limit_.reset();
      halt_in_accumulation();
    }
    return limit_.has_value();
  }
  return false;
}

/// Whether the motion of the last throw would lead away from the edge until the limit: as many throws are
/// still to come, each of them within rounding.
bool Simulation::leaves_edge_before_limit(const Contact& contact, const Vector2d& position) {
  constexpr double many = 0x1p+12;
  const scene::Shape& shape = ground_->shape(contact.region);
  const Vector2d normal = local_edge(shape, contact.piece, position)->normal;
  const PointState center = segment_.at(0).center;
  const double left = epoch_.until(limit_->time.value) + limit_->time.remainder;
  const double away =
      (std::abs(center.velocity.dot(normal)) + 0.5 * left * std::abs(center.acceleration.dot(normal))) * left;
  return away > many * unseen * (position.norm() + size_of(shape));
}

/// One ground throws the sphere back, with less and less speed: until it does not.
void Simulation::find_limit_on_edge(const Contact& contact, const Vector2d& position) {
  LocalEdge edge = *local_edge(ground_->shape(contact.region), contact.piece, position);
  if (contact.region != thrown_->from) edge = {-edge.normal, -edge.bend};
  // On that ground the speed across the edge is p_c.n + kappa u.n, also where the sphere is not on it.
  const double along = thrown_->velocity.dot(turned(edge.normal));
  const double speed = thrown_->velocity.dot(edge.normal);
  const double push = thrown_->acceleration.dot(edge.normal) + edge.bend * along * along;
  if (!(push > 0)) return;
  const double left = last_throw(contact, edge.normal, std::max(0.0, -speed / push));
  limit_ = {epoch_.plus(left), Vector2d::Zero(), thrown_->from, no_region, contact};
}

/// When the speed across the edge which the ground that throws would give has come to 0, on the way on which
/// the sphere is now: what changes p_c there need not be what changes it on that ground.
/// @param normal  of the edge at the last throw, into the ground that throws
/// @param guess   since the beginning of the segment [s]
double Simulation::last_throw(const Contact& contact, const Vector2d& normal, double guess) {
  const scene::Shape& shape = ground_->shape(contact.region);
  const scene::Material& ground = ground_->material(thrown_->from);
  const auto across = [&](double tau) {
    segment_.reach(tau);
    const MotionState now = segment_.at(tau);
    Vector2d here = local_edge(shape, contact.piece, now.center.position)->normal;
    if (here.dot(normal) < 0) here = -here;
    const Vector2d conserved = sphere_.conserved_velocity({now.center.velocity, now.angular_velocity});
    return (conserved + sphere_.kappa() * ground_velocity(ground, now.center.position)).dot(here);
  };
  // A guess of later than the forces change the motion is none, and would be followed without a question.
  constexpr double many = 16;
  constexpr double many_steps = 1024;
  const scene::Solver& solver = segment_.solver();
  const double steps = solver.has_fixed_step() ? many_steps * solver.step : never;
  if (guess > std::min(many * segment_.time_scale(), steps)) return guess;
  const double limit = 4 * guess;
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

void Simulation::find_limit_in_corner(const ZenoDetector::Cycle& cycle) {
  const ZenoDetector::Arrival& last = *cycle.last;
  const ZenoDetector::Arrival& other = *cycle.opposite;
  if (other.contact.region == no_region || other.entered == last.entered) return;
  const scene::Shape& a = ground_->shape(last.contact.region);
  const scene::Shape& b = ground_->shape(other.contact.region);
  const double rounding = unseen * (size_of(a) + size_of(b));
  const auto corner = corner_of(a, last.contact.piece, b, other.contact.piece, rounding);
  const double way = (last.position - other.position).norm();
  if (!corner || !((*corner - cycle.limit).norm() <= way + rounding)) return;
  limit_ = {epoch_.plus(cycle.remaining), *corner, last.entered, other.entered};
}

/// The last instant of an accumulation: what the sphere then does is a motion like others.
void Simulation::pass_limit(const SwitchSink& on_switch) {
  edge_events_.pass_without_crossing();
  zeno_.clear();
  limit_passed_at_ = now_;
  const double tau = std::max(0.0, epoch_.until(next_instant_) + next_remainder_);
  const MotionState now = segment_.told_at(tau);
  Arrival arrival = arrive(tau, now, now.center.position, Cause::accumulation);
  arrival.restarts = arrival.complete = true;
  arrival.state.orientation = segment_.orientation(tau).normalized();
  // It is passed whatever a sink throws.
  const struct Passed {
    std::optional<Limit>& limit;
    ~Passed() { limit.reset(); }
  } passed{limit_};
  if (limit_->other != no_region) {
    pass_corner(arrival, on_switch);
    return;
  }
  const scene::Shape& shape = ground_->shape(limit_->edge.region);
  Vector2d& position = arrival.state.position;
  position = put_on_edge(shape, limit_->edge.piece, position);
  limit_->normal = local_edge(shape, limit_->edge.piece, position)->normal;
  if (limit_->ground != limit_->edge.region) limit_->normal = -limit_->normal;
  enter_ground(limit_->ground, arrival, on_switch);
}

/// Two grounds throw the sphere at each other in a corner: along the edge between them, if one goes on there.
void Simulation::pass_corner(Arrival& arrival, const SwitchSink& on_switch) {
  const RegionId first = limit_->ground;
  const RegionId second = limit_->other;
  arrival.state.position = limit_->position;
  visited_ = {first, second};
  for (const RegionId region : ground_->edges_seen_at(limit_->position))
    pieces_at(ground_->shape(region), region, limit_->position, contacts_);
  const std::optional<SharedEdge> ahead = edge_ahead(first, second, arrival.state);
  const bool slides = ground_->surface().livelock == scene::Livelock::slide;
  if (ahead && !slides) halt_in_livelock();
  if (!ahead) halt_in_accumulation();
  // Of a region's contacts the first one is the edge, and the last one what a straight path starts on.
  complete(arrival);
  const Contacts crossed = std::exchange(contacts_, {ahead->piece});
  for (const RegionId region : {first, second}) add_corner(region, limit_->position);
  for (const Contact& contact : crossed) add_corner(contact.region, limit_->position);
  if (!slide_along_edge(*ahead, arrival, on_switch)) halt_in_accumulation();
}

/// Adds the corner of a region, where the sphere is in one.
void Simulation::add_corner(RegionId region, const Vector2d& corner) {
  const auto* polygon = region == base_region ? nullptr : std::get_if<Polygon>(&ground_->shape(region));
  if (polygon) {
    const auto found = std::find(polygon->vertices.begin(), polygon->vertices.end(), corner);
    const auto index = static_cast<std::int32_t>(found - polygon->vertices.begin());
    if (found != polygon->vertices.end()) {
      insert({region, {EdgePiece::Kind::vertex, index}}, contacts_);
      return;
    }
  }
  add_contacts(region, corner);
}

/// Thrown to and fro in shorter and shorter times, without end in a finite time, and with no motion after it.
void Simulation::halt_in_accumulation() {
  std::ostringstream reason;
  const Vector2d position = segment_.at(std::max(0.0, epoch_.until(now_))).center.position;
  reason << "switches accumulate at t = " << now_ << " s, x = " << position.x() << " m, y = " << position.y()
         << " m, last on \"" << ground_->name(region_) << "\", and no motion along the edge is known";
  halt(reason.str());
}

}  // namespace hybrid_sphere
