#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <optional>

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"
#include "python/python_function.hpp"

namespace hybrid_sphere::python {

/// q' = W = B(q) v, with derivatives. See mechanics::QuasiVelocities for the Hamel terms.
struct KinematicTerms {
  Vector rate;                   ///< W (N)
  mechanics::Matrix directions;  ///< B (N x n)
  Vector drift;                  ///< (DB v) W (N)
  mechanics::Matrix brackets;    ///< column j: B^+ ((DB_j) W - (DW) B_j) (n x n)
};

/// Equations of motion from functions written in Python, differentiated exactly, with the sizes known at run
/// time only: what mechanics::AutomaticEquations is. Takes the lock of the interpreter where it calls them.
class PythonEquations final : public mechanics::EquationsOfMotion {
 public:
  struct Functions {
    PythonFunction lagrangian;
    std::optional<PythonFunction> forces;  ///< none: 0
    std::optional<PythonFunction> rate;    ///< none: q' = v
  };
  PythonEquations(Index coordinates, Index velocities, Functions functions);

  Index coordinates() const override { return coordinates_; }
  Index velocities() const override { return velocities_; }
  void evaluate(double t, const Vector& q, const Vector& v, mechanics::MotionTerms& terms) const override;
  void momentum(double t, const Vector& q, const Vector& v, Vector& p,
                mechanics::Matrix& mass) const override;
  void rate(const Vector& q, const Vector& v, Vector& rate) const override;
  void directions(const Vector& q, const Vector& v, mechanics::Matrix& directions,
                  Vector& drift) const override;

 private:
  KinematicTerms kinematics(const Vector& q, const Vector& v) const;
  void set_directions(const Vector& q, const Vector& v, KinematicTerms& terms,
                      mechanics::Matrix& change) const;
  mechanics::Matrix along_directions(const Vector& q, const Vector& v,
                                     const mechanics::Matrix& directions) const;
  void set_momentum(const Operand& lagrangian, Vector& p, mechanics::Matrix& mass) const;
  void add_forces(double t, const Vector& q, const Vector& v, Vector& sum) const;

  Index coordinates_;
  Index velocities_;
  PythonFunction lagrangian_;
  std::optional<PythonFunction> forces_;
  std::optional<PythonFunction> rate_;
};

}  // namespace hybrid_sphere::python
