#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "study/permutation.hpp"
#include "study/stream.hpp"

namespace hybrid_sphere::study {

/// How the points of a study fill the unit cube.
enum class Sampling {
  random,           ///< independent points
  latin_hypercube,  ///< each of `runs` equal parts of a variable has one point
  sobol,            ///< Sobol's sequence from its first point, the origin, on, shifted digitally by the seed
  grid,             ///< all combinations of levels, the last variable fastest; level j of L is at (j + 1/2)/L
};

/// What the points are determined by.
struct Design {
  Sampling sampling = Sampling::random;
  std::uint64_t seed = 0;
  std::uint64_t runs = 0;              ///< of the whole study
  std::vector<std::string> variables;  ///< their paths
  std::vector<std::uint64_t> levels;   ///< of each variable, for a grid
  bool saltelli = false;               ///< for Sobol' indices: see Sampler
};

/// @throws std::invalid_argument  that says what is allowed: no, or repeated, or too many variables; no or
/// more
///   than 2^53 runs; a grid with other levels than variables, a level 0, another product of levels than runs,
///   or `saltelli`; runs with `saltelli` that are no multiple of d + 2
void require_valid(const Design& design);

/// The points of a study: that of run i is a function of the design and of i alone, whoever computes it.
/// Other variables do not change those of a variable, except that Sobol's sequence has dimensions in the
/// order of the variables. The runs of a random study do not depend on how many there are.
///
/// With `saltelli` runs come in groups of d + 2 for d variables: the points A and B, and A with the component
/// j of B in place of its own, j = 0 .. d-1 (A. Saltelli et al., Comput. Phys. Commun. 181 (2010) 259-270).
/// The parts of a Latin hypercube are then as many as groups, those of A and of B each; A and B are the first
/// and the last d of 2 d dimensions of Sobol's sequence. The last group may be incomplete.
class Sampler {
 public:
  /// Takes a design that require_valid has accepted, or one with an incomplete last group.
  explicit Sampler(Design design);

  /// Fills the points of the runs first .. first + count - 1, each in (0, 1)^d, a run after another.
  /// @param out  count * d numbers
  /// @throws std::out_of_range  if the study has fewer runs
  void points(std::uint64_t first, std::uint64_t count, double* out) const;

 private:
  void fill(std::uint64_t first, std::uint64_t count, double* out) const;
  void fill_random(std::uint64_t first, std::uint64_t count, double* out) const;
  void fill_latin_hypercube(std::uint64_t first, std::uint64_t count, double* out) const;
  void fill_sobol(std::uint64_t first, std::uint64_t count, double* out) const;
  void fill_grid(std::uint64_t first, std::uint64_t count, double* out) const;
  void fill_groups(std::uint64_t first, std::uint64_t count, double* out) const;

  /// A component of the points: those of B come after those of A.
  struct Component {
    Stream stream;
    std::uint64_t part;  ///< 0 of A, 1 of B
  };

  Design design_;
  std::uint64_t group_size_;  // runs that are made of one point of all components
  std::uint64_t groups_;
  std::vector<Component> components_;      // d, or 2 d with saltelli
  std::vector<Permutation> strata_;        // of each component, of a Latin hypercube
  std::vector<std::uint64_t> shifts_;      // of each component, of Sobol's sequence
  std::vector<std::uint64_t> directions_;  // of all components, for each bit of the index
};

}  // namespace hybrid_sphere::study
