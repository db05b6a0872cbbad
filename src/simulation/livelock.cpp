// Grounds that throw the sphere at each other, and the slide along the edge between them: docs/theory.md 5.4.
#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "edge_line.hpp"
#include "hybrid_sphere/simulation/simulation.hpp"

namespace hybrid_sphere {
namespace {

/// How far beside an edge to look for the grounds on its two sides, as a part of the way along it: between
/// the edge and a circle that touches it.
/// @param ahead  along the edge, of length 1
/// @param step   the way along it, from a place on all the contacts [m]
double part_aside(const Ground& ground, const Contacts& contacts, const Vector2d& place,
                  const Vector2d& ahead, double step) {
  constexpr double usual = 0x1p-18;
  double part = usual;
  for (const Contact& contact : contacts) {
    const auto* circle = std::get_if<scene::Circle>(&ground.shape(contact.region));
    if (!circle) continue;
    const bool touches = std::abs((place - circle->center).dot(ahead)) <= usual * circle->radius;
    if (touches) part = std::min(part, 0.25 * step / circle->radius);
  }
  return part;
}

}  // namespace

using scene::Law;

/// Two or more grounds throw the sphere at each other, without end: docs/theory.md 5.4.
/// @param again  the ground that would be entered a second time
void Simulation::resolve_livelock(RegionId again, const SwitchSink& on_switch) {
  const auto first = std::find(visited_.begin(), visited_.end(), again);
  visited_.erase(visited_.begin(), first);
  if (ends_throws(arrival_.state.position)) return;
  if (ground_->surface().livelock == scene::Livelock::slide && visited_.size() == 2) {
    complete(arrival_);
    // Where it was put there the path that led there, none, does not tell.
    for (const RegionId region : ground_->edges_seen_at(arrival_.state.position))
      add_contacts(region, arrival_.state.position);
    const std::optional<SharedEdge> edge = is_in_corner()
                                               ? edge_ahead(visited_[0], visited_[1], arrival_.state)
                                               : edge_between(visited_[0], visited_[1]);
    if (edge && slide_along_edge(*edge, arrival_, on_switch)) return;
  }
  halt_in_livelock();
}

/// Whether a ground gives the sphere a velocity of its own.
bool Simulation::strikes(RegionId region) const {
  return ground_->law(region) == Law::rough || ground_->law(region) == Law::rubber;
}

bool Simulation::is_ground(RegionId region, const scene::Material& material) const {
  return same_ground(ground_->material(region), material);
}

/// Whether edges of several directions meet where the sphere is.
bool Simulation::is_in_corner() const {
  std::optional<EdgeLine> first;
  bool on_circle = false;
  for (const Contact& contact : contacts_) {
    if (contact.piece.kind == EdgePiece::Kind::vertex) return true;
    const std::optional<EdgeLine> line = line_of(ground_->shape(contact.region), contact.piece);
    if (line && first && !are_parallel(*first, *line)) return true;
    if (line) first = line;
    if (!line) on_circle = true;
  }
  return first && on_circle;
}

/// The straight edge between two regions on which the sphere is.
std::optional<Simulation::SharedEdge> Simulation::edge_between(RegionId first, RegionId second) const {
  for (const Contact& contact : contacts_) {
    if (contact.region != first && contact.region != second) continue;
    const scene::Shape& shape = ground_->shape(contact.region);
    if (contact.piece.kind != EdgePiece::Kind::line) continue;
    const Vector2d inwards = local_edge(shape, contact.piece, arrival_.state.position)->normal;
    return SharedEdge{contact, first, second, contact.region == first ? inwards : Vector2d(-inwards)};
  }
  return std::nullopt;
}

/// Adds the edges of a region on which the sphere exactly is.
void Simulation::add_contacts(RegionId region, const Vector2d& position) {
  const auto [known, end] = contacts_of(contacts_, region);
  if (known != end || region == base_region) return;
  const scene::Shape& shape = ground_->shape(region);
  if (locate(shape, position) == Side::edge) pieces_at(shape, region, position, contacts_);
}

/// The edge between two grounds that leads away from a place in the direction in which the sphere would slide
/// along it, thrown from one to the other.
std::optional<Simulation::SharedEdge> Simulation::edge_ahead(RegionId first, RegionId second,
                                                             const Segment::Start& state) const {
  const Vector2d& corner = state.position;
  const scene::Material& a = ground_->material(first);
  const scene::Material& b = ground_->material(second);
  const Vector2d conserved = sphere_.conserved_velocity(state.twist);
  const Vector2d of_first = conserved + sphere_.kappa() * a.belt;
  const Vector2d of_second = conserved + sphere_.kappa() * b.belt;
  for (const Contact& piece : contacts_) {
    const scene::Shape& shape = ground_->shape(piece.region);
    const std::optional<EdgeLine> line = line_of(shape, piece.piece);
    if (!line) continue;
    for (const double sense : {1.0, -1.0}) {
      const Vector2d ahead = sense * line->direction.normalized();
      // A little way along it the two grounds lie on its two sides, and only there: also where another edge
      // leads away from the corner at a small angle, or a circle that touches it.
      const double step = 0x1p-24 * (corner.norm() + size_of(shape) + sphere_.radius());
      const Vector2d aside = part_aside(*ground_, contacts_, corner, ahead, step) * turned(ahead);
      const RegionId left = ground_->top_region(corner + step * (ahead + aside));
      const RegionId right = ground_->top_region(corner + step * (ahead - aside));
      const bool first_is_left = is_ground(left, a) && is_ground(right, b);
      const bool first_is_right = is_ground(left, b) && is_ground(right, a);
      if (!first_is_left && !first_is_right) continue;
      const Vector2d normal = (first_is_left ? 1 : -1) * turned(ahead);
      const double away = of_first.dot(normal);
      const double back = of_second.dot(normal);
      if (!(away < 0 && back > 0)) continue;
      if (!((back * of_first - away * of_second).dot(ahead) > 0)) continue;
      return SharedEdge{piece, first_is_left ? left : right, first_is_left ? right : left, normal};
    }
  }
  return std::nullopt;
}

/// What is followed are the pieces of edge of the two grounds on one line.
void Simulation::follow(const SharedEdge& edge) {
  const EdgeLine line = *line_of(ground_->shape(edge.piece.region), edge.piece.piece);
  const auto is_piece = [&](const Contact& contact) {
    return contact.region == edge.piece.region && contact.piece.kind == EdgePiece::Kind::line &&
           contact.piece.index == edge.piece.piece.index;
  };
  if (std::none_of(contacts_.begin(), contacts_.end(), is_piece)) insert(edge.piece, contacts_);
  for (Contact& contact : contacts_) {
    const bool of_these =
        contact.region == edge.first || contact.region == edge.second || contact.region == edge.piece.region;
    const std::optional<EdgeLine> other = line_of(ground_->shape(contact.region), contact.piece);
    contact.followed = of_these && other && are_parallel(*other, line);
  }
}

bool Simulation::slide_along_edge(const SharedEdge& edge, Arrival& arrival, const SwitchSink& on_switch) {
  const Dynamics& dynamics = segment_.dynamics();
  const scene::Material& a = ground_->material(edge.first);
  const scene::Material& b = ground_->material(edge.second);
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
  const SplitTime instant = epoch_.plus(arrival.tau, arrival.tau_remainder);
  event.time = instant.value;
  event.time_remainder = instant.remainder;
  EdgeSlide slide(dynamics, a.belt, b.belt, edge.normal, state.position,
                  sphere_.conserved_velocity(state.twist),
                  NormalSpin(state.twist.angular_velocity.z(), dynamics.normal_spin, 0, 0, 0));
  const MotionState after = slide.at(0);
  event.slip_before = state.contact_velocity - a.belt;
  event.impulse = sphere_.mass() * (after.center.velocity - state.twist.velocity);
  event.angular_impulse = sphere_.angular_impulse(event.impulse);
  state.twist = {after.center.velocity, after.angular_velocity};
  state.contact_velocity = after.contact_velocity;
  follow(edge);
  epoch_ = instant;
  try {
    segment_.begin_edge_slide(slide, state);
  } catch (...) {
    detach(before);
    throw;
  }
  ahead_ = Ahead::to_slide;
  arrival.tau = arrival.tau_remainder = 0;
  if (arrival.cause != Cause::accumulation) arrival.cause = Cause::livelock;
  arrival_ = arrival;
  slid_along_ = edge;
  commit_transition(edge.first, constraint_of(ContactMode::edge_sliding, a), arrival_, event, on_switch,
                    edge.second);
  return true;
}

void Simulation::halt_in_livelock() {
  std::ostringstream reason;
  const Vector2d position = segment_.at(std::max(0.0, epoch_.until(now_))).center.position;
  reason << "livelock at t = " << now_ << " s, x = " << position.x() << " m, y = " << position.y()
         << " m: thrown for ever from";
  for (const RegionId region : visited_) reason << " \"" << ground_->name(region) << "\" to";
  reason << " \"" << ground_->name(visited_.front()) << "\"; "
         << (ground_->surface().livelock == scene::Livelock::stop
                 ? "surface.livelock is stop"
                 : "no motion along an edge between them is known");
  halt(reason.str());
}

}  // namespace hybrid_sphere
