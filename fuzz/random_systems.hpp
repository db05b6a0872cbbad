#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::fuzz {

/// A system of three coordinates with contacts, frictions, events that reset velocities and constraints that
/// come and go, as numbers: so it can be printed, and written in other units.
struct RandomSystem {
  /// gap = normal q + offset + wave sin(q_0)
  struct Contact {
    Eigen::Vector3d normal;
    double offset;
    double wave;
    double restitution;
    Eigen::Matrix<double, 2, 3> tangents;  ///< the slip is tangents v
    int slip_components;                   ///< 0: smooth
    double coefficient;
    double static_coefficient;
  };
  /// abs(lambda) <= coefficient load, of the slip directions v
  struct LoadedFriction {
    Eigen::Matrix<double, 2, 3> directions;
    double coefficient;
    double load;
  };
  /// g = normal q + offset, or normal v + offset
  struct Event {
    Eigen::Vector3d normal;
    double offset;
    bool of_velocities;
    mechanics::Crossing crossing;
    std::optional<double> kept;  ///< part of the velocities that a reset keeps
  };
  /// f = (a cos(turn q_2) + b sin(turn q_2)) v, from begin to end, or while guard q + guard_offset > 0
  struct Constraint {
    Eigen::Vector3d a, b;
    double turn;
    double begin, end;
    std::optional<Eigen::Vector3d> guard;
    double guard_offset;
  };

  Eigen::Matrix3d mass;
  double mass_wave;  ///< M = mass (1 + mass_wave cos q_1)
  Eigen::Vector3d weight;
  Eigen::Vector3d stiffness;
  double damping;
  Eigen::Vector3d drive;  ///< a force that turns: drive_i cos(drive_rate t + i)
  double drive_rate;
  std::vector<Contact> contacts;
  std::optional<LoadedFriction> friction;
  std::vector<Event> events;
  std::optional<Constraint> constraint;
  Eigen::Vector3d velocity;  ///< at the start, where all coordinates are 0
  double duration;
  double accuracy;

  bool is_driven() const { return drive.norm() > 0; }
  /// Nothing but impulses takes energy from the motion.
  bool keeps_energy_between_switches() const;
  std::string text() const;
};

/// Units of length, time and mass, in those of a RandomSystem.
struct Units {
  double length = 1;
  double time = 1;
  double mass = 1;
  double energy() const { return mass * length * length / (time * time); }
};

RandomSystem draw_random_system();

/// The system in other units; `random` must outlive it.
mechanics::System<3> system_of(const RandomSystem& random, const Units& units = {});
mechanics::Initial start_of(const RandomSystem& random, const Units& units = {});

}  // namespace hybrid_sphere::fuzz
