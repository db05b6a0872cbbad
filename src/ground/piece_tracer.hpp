#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/certified_root.hpp"
#include "ground/trace_curve.hpp"
#include "interrupt/interrupt.hpp"

namespace hybrid_sphere {

/// Finds the roots of one piece of edge along a path.
class PieceTracer {
 public:
  PieceTracer(const CurvedPath& path, const EdgePiece& piece, Candidates& candidates)
      : path_(path), piece_(piece), candidates_(candidates) {}

  /// @return  the time until which the path lies on the piece, to within rounding
  template <class Edge>
  double run(const Edge& edge, bool contact) {
    if (path_.curve.form == CurveForm::general) pull_ = bend(edge, path_.from, path_.from);
    if (contact && stays_within_rounding(edge)) return path_.until;
    if (path_.curve.form == CurveForm::arc) {
      return is_flat(edge) ? run_flat_arc(edge, contact) : run_arc(edge, contact);
    }
    if constexpr (Edge::is_line) {
      if (path_.curve.form == CurveForm::parabola) return run_parabola(edge, contact);
    }
    const Leave leave = contact ? leave_contact(edge) : Leave{path_.from, path_.from};
    if (leave.search_from >= path_.until) return leave.left;
    const std::size_t samples_before = path_.samples;
    const auto curvature = [&](double from, double until) {
      const double bound = bend(edge, from, until);
      return path_.samples - samples_before < max_samples ? bound
                                                          : std::min(bound, seen_bend(edge, from, until));
    };
    const std::size_t known = candidates_.size();
    geometry::certified_roots([&](double t) { return sample(edge, t); }, curvature, leave.search_from,
                              path_.until,
                              [&](const Root& root) {
                                add(root);
                                return true;
                              });
    const bool may_be_missed = path_.is_integrated && candidates_.size() == known;
    if (may_be_missed && !contact) add_between_ends(edge);
    // Before the search begins the path is on the side that it has left the contact to.
    if (may_be_missed && contact)
      add_if_crossed(sample(edge, leave.search_from), edge.jet(path_.last), edge, leave.search_from);
    return leave.left;
  }

 private:
  using Jet = geometry::Jet;
  using Root = geometry::Root;
  static constexpr std::size_t max_samples = 4096;  // evaluations of a path, for one piece of edge

  /// The displacement is no better than the rounding of the velocities and of what the forces add to them,
  /// even if the place has none, at 0, or if the forces cancel.
  template <class Edge>
  Jet sample(const Edge& edge, double time) const {
    ++path_.samples;
    seen_at_ = time;
    seen_ = path_.at(time);
    Jet jet = edge.jet(seen_);
    const double speed = std::abs(edge.rate(seen_.position, path_.velocity)) +
                         std::abs(edge.rate(seen_.position, path_.contact_velocity)) +
                         std::abs(edge.rate(seen_.position, path_.reference_velocity));
    jet.noise = std::max(jet.noise, 4 * DBL_EPSILON * (speed + pull_ * time) * time);
    return jet;
  }

  template <class Edge>
  double bend(const Edge& edge, double from, double until) const {
    const double middle = from + 0.5 * (until - from);
    if (seen_at_ != middle) sample(edge, middle);
    return edge.curvature(path_.motion, seen_, from, until);
  }

  // Along an edge from which the path is indistinguishable, a bound that does not know it would lead to
  // endless halving. There the curvature is taken from the observed slopes, with a margin.
  template <class Edge>
  double seen_bend(const Edge& edge, double from, double until) const {
    const double middle = from + 0.5 * (until - from);
    const double low = sample(edge, from).slope;
    const double high = sample(edge, until).slope;
    const double slope = sample(edge, middle).slope;
    return 16 * std::max(std::abs(high - slope), std::abs(slope - low)) / (until - middle);
  }

  void add(const Root& root) { candidates_.push_back({root.time, root.error, piece_}); }

  // Places of an integrated path differ from the integral of its velocities by part of a step's tolerance, so
  // that the velocities may rule out a root right at the beginning, or one under the greatest acceleration.
  template <class Edge>
  void add_between_ends(const Edge& edge) {
    const Jet first = edge.jet(path_.first);
    const Jet last = edge.jet(path_.last);
    if (std::abs(first.value) <= first.noise) {
      const double error = std::min(2 * first.noise / std::abs(first.slope), path_.until - path_.from);
      add({path_.from, error + DBL_EPSILON * path_.from});
    } else {
      add_if_crossed(first, last, edge, path_.from);
    }
  }

  /// Adds a root where the signs at a time and at the end of the piece are told, and differ.
  template <class Edge>
  void add_if_crossed(const Jet& first, const Jet& last, const Edge& edge, double from) {
    const bool is_told = std::abs(first.value) > first.noise && std::abs(last.value) > last.noise;
    if (!is_told || (first.value < 0) == (last.value < 0)) return;
    add(geometry::refined_root([&](double t) { return sample(edge, t); }, from, path_.until, first.value,
                               last.value));
  }

  void add_if_inside(const Root& root) {
    if (root.time + root.error >= path_.from && root.time - root.error <= path_.until) add(root);
  }

  struct Leave {
    double search_from;  // no root before it except the contact
    double left;         // until then the path is indistinguishable from lying on the contact
  };

  // From a point of the edge the path cannot come back to it before 2 |g'|/M; halfway it has moved away by
  // g'^2/(2 M). If rounding hides that, it is on the edge, as far as can be known, while it stays within the
  // rounding of g; but a path that begins at rest leaves where it is pushed, at once.
  template <class Edge>
  Leave leave_contact(const Edge& edge) const {
    const double from = path_.from;
    const double until = path_.until;
    const double most = bend(edge, from, until);
    const Jet start = sample(edge, from);
    if (most == 0) return {until, start.slope == 0 ? until : from};
    const double least = std::max(0x1p-52 * (until - from), resolution(edge, most));
    const double certain = std::abs(start.slope) / most;
    const bool comes_away = certain >= least && std::abs(start.slope) * certain > 4 * start.noise;
    const double first = comes_away ? certain : std::max(8 * std::sqrt(start.noise / most), least);
    for (double step = first;; step *= 2) {
      interruption_point();
      const double time = std::min(from + step, until);
      const Jet there = sample(edge, time);
      if (std::abs(there.value) > 2 * there.noise) {
        const bool at_once = (comes_away && step == first) || is_pushed_away(edge, start, there, time);
        return {time, at_once ? from : time};
      }
      if (time == until) return {until, until};
    }
  }

  /// Whether the path begins at rest across the edge, to within rounding, and the acceleration there has led
  /// to where it is at `time`.
  template <class Edge>
  bool is_pushed_away(const Edge& edge, const Jet& start, const Jet& there, double time) const {
    sample(edge, path_.from);
    const double push = edge.rate(seen_.position, seen_.acceleration);
    const double passed = time - path_.from;
    const double gradient = gradient_of(edge);
    const double pull = gradient * path_.motion.acceleration_bound(path_.from, time);
    const bool is_told = std::abs(push) > 64 * DBL_EPSILON * pull;
    const bool rests = std::abs(start.slope) <= 64 * DBL_EPSILON * gradient * speed_at_start();
    const double way = 0.5 * push * passed * passed;
    return is_told && rests && std::abs(there.value - way) <= 0.25 * std::abs(way) + there.noise;
  }

  /// Of the edge's function at the place that was sampled last.
  template <class Edge>
  double gradient_of(const Edge& edge) const {
    return std::hypot(edge.rate(seen_.position, Vector2d::UnitX()),
                      edge.rate(seen_.position, Vector2d::UnitY()));
  }

  double speed_at_start() const {
    return path_.velocity.norm() + path_.contact_velocity.norm() + path_.reference_velocity.norm();
  }

  /// A velocity is computed from those of the centre and of the contact, and is no better than their
  /// rounding: for this long, the displacement due to it alone cannot be resolved [s].
  /// @param most  of the edge's curvature along the path
  template <class Edge>
  double resolution(const Edge& edge, double most) const {
    const double gradient = gradient_of(edge);
    const double pull = gradient * path_.motion.acceleration_bound(path_.from, path_.until);
    return 64 * DBL_EPSILON * gradient * speed_at_start() / std::max(most, pull);
  }

  /// Whether a piece of path is so short that it is indistinguishable from lying on the edge on which it
  /// starts.
  template <class Edge>
  bool stays_within_rounding(const Edge& edge) const {
    const double duration = path_.until - path_.from;
    const Jet start = sample(edge, path_.from);
    const double way = std::abs(start.slope) * duration;
    return way <= 2 * start.noise &&
           way + 0.5 * bend(edge, path_.from, path_.until) * duration * duration <= 2 * start.noise;
  }

  /// Whether the path leaves the edge by more than rounding between its contact and its return.
  template <class Edge>
  bool is_told_from_contact(const Edge& edge, const LineFunction::Quadratic& q) const {
    const double noise = edge.jet({path_.curve.start, path_.curve.velocity, path_.curve.acceleration}).noise;
    return q.c1.value * q.c1.value > 2 * std::abs(q.c2.value) * noise;
  }

  /// When a path comes back to the edge on which it begins, in a time tau or a function of it that begins
  /// like it. The place at its beginning is rounded: other functions of the line, and other pieces of the
  /// path, which take it as it is, find the return that much earlier or later.
  /// @return none where it cannot be told from the beginning
  template <class Edge>
  std::optional<Root> time_of_return(const Edge& edge, const LineFunction::Quadratic& q) const {
    const double time = -2 * q.c1.value / q.c2.value;
    if (!std::isfinite(time) || !is_told_from_contact(edge, q)) return std::nullopt;
    const double rounding = 2 * (std::abs(q.c0.value) + q.c0.error) / std::abs(q.c1.value);
    return Root{time, 8 * DBL_EPSILON * std::abs(time) + rounding};
  }

  double run_parabola(const LineFunction& line, bool contact) {
    const LineFunction::Quadratic q = line.along(path_.curve);
    const bool along = q.c1.value == 0 && q.c2.value == 0;
    if (along && (contact || !q.c0.has_sign())) return path_.until;
    // A later piece of the path is on its contact at path_.from, not at the start of the segment.
    if (contact && path_.from == 0) {
      if (const auto back = time_of_return(line, q)) add_if_inside(*back);
      return path_.from;
    }
    if (!q.may_vanish(path_.until)) return path_.from;
    Root roots[2];
    const int count = q.solve(roots);
    for (int i = 0; i < count; ++i) {
      const bool is_contact = contact && std::abs(roots[i].time - path_.from) <= 2 * roots[i].error;
      if (!is_contact) add_if_inside(roots[i]);
    }
    return path_.from;
  }

  /// Whether the orbit is so large that the rounding of its centre is more than that of the map.
  template <class Edge>
  bool is_flat(const Edge& edge) const {
    return path_.curve.arm.norm() > path_.curve.start.norm() + edge.size();
  }

  template <class Edge>
  double run_flat_arc(const Edge& edge, bool contact) {
    const double rate = path_.curve.rate;
    const double period = 2 * M_PI / std::abs(rate);
    const auto q = edge.along_arc(path_.curve);
    Root roots[2];
    int count = 0;
    if (contact && path_.from == 0) {
      if (const auto back = time_of_return(edge, q)) roots[count++] = *back;
    } else if (!(std::abs(rate) * path_.until < 1) || q.may_vanish(path_.until)) {  // u <= t there
      count = q.solve(roots);
    }
    for (int i = 0; i < count; ++i) {
      const double tangent = rate * roots[i].time;
      roots[i].time = 2 * std::atan(tangent) / rate;
      roots[i].error =
          4 * roots[i].error / (1 + tangent * tangent) + 4 * DBL_EPSILON * std::abs(roots[i].time);
    }
    if (q.c2.value == 0) roots[count++] = {0.5 * period, DBL_EPSILON * period};
    for (int i = 0; i < count; ++i) {
      const double error = roots[i].error + DBL_EPSILON * path_.from;
      const bool is_contact = contact && path_.from > 0 && std::abs(roots[i].time - path_.from) <= 2 * error;
      double time = roots[i].time;
      if (is_contact || time + error < path_.from) {
        time += period * std::max(1.0, std::ceil((path_.from - error - time) / period));
      }
      for (; time - error <= path_.until; time += period) {
        interruption_point();
        add_if_inside({time, error});
      }
    }
    return path_.from;
  }

  template <class Edge>
  double run_arc(const Edge& edge, bool contact) {
    const Curve& arc = path_.curve;
    double angles[2];
    double error = 0;
    if (!edge.meets_circle(arc.orbit_center, arc.arm.norm(), angles, error)) {
      return contact && error < 0 ? path_.until : path_.from;
    }
    const double phase = std::atan2(arc.arm.y(), arc.arm.x());
    const double period = 2 * M_PI / std::abs(arc.rate);
    const double turns = path_.from / period;
    const double time_error = error / std::abs(arc.rate) + 2 * DBL_EPSILON * (1 + turns) * period;
    double ahead[2];  // of path_.from
    for (int i = 0; i < 2; ++i)
      ahead[i] = std::remainder((angles[i] - phase) / arc.rate - path_.from, period);
    const int touching = std::abs(ahead[0]) <= std::abs(ahead[1]) ? 0 : 1;
    for (int i = 0; i < 2; ++i) {
      const bool is_contact = contact && (i == touching || std::abs(ahead[i]) <= time_error);
      double time = path_.from + (is_contact ? period : ahead[i]);
      if (!is_contact && ahead[i] < -time_error) time += period;
      for (; time - time_error <= path_.until; time += period) {
        interruption_point();
        add_if_inside({time, time_error});
      }
    }
    return path_.from;
  }

  const CurvedPath& path_;
  EdgePiece piece_;
  Candidates& candidates_;
  mutable double seen_at_ = -1;  // the time of the last evaluation
  double pull_ = 0;              // by all forces on an integrated path across the edge
  mutable PointState seen_{};
};

}  // namespace hybrid_sphere
