#include "mechanics/schur_complement.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mechanics/small_rows.hpp"

namespace hybrid_sphere::mechanics {
namespace {

// Pivots below this part of the diagonal are left to SaddlePoint.
constexpr double least_pivot = 1.0 / 64;

}  // namespace

void SchurComplement::set_pattern(BlockPattern pattern) {
  pattern_ = std::move(pattern);
  const std::size_t n = pattern_.velocities();
  const std::size_t g = pattern_.rows();
  for (Numbers* numbers : {&triangles_, &mass_}) numbers->assign(n * pattern_.block(), 0);
  is_mass_decomposed_ = false;
  is_diagonal_.assign(pattern_.blocks(), 0);
  for (Numbers* numbers : {&rows_, &images_, &weighted_}) numbers->assign(pattern_.entry_numbers(), 0);
  for (Numbers* numbers : {&complement_, &scaled_}) numbers->assign(pattern_.triangle_numbers(), 0);
  for (Numbers* numbers : {&inverse_mass_, &velocities_}) numbers->assign(n, 0);
  for (Numbers* numbers : {&diagonal_, &inverse_complement_, &multipliers_}) numbers->assign(g, 0);
  of_row_.assign(std::max(pattern_.block(), g), 0);
  ties_.clear();
  ties_.reserve(g);
  source_.assign(g, 0);
  chosen_.reserve(g);
  kept_.assign(pattern_.groups().size(), {});
  are_all_ = false;
  set_rows(nullptr);
}

/// Sets the rows that count.
void SchurComplement::set_rows(const std::vector<Index>* rows) {
  if (rows == nullptr ? are_all_ : !are_all_ && *rows == chosen_) return;
  are_all_ = rows == nullptr;
  if (rows != nullptr) chosen_ = *rows;
  count_ = 0;
  for (std::size_t a = 0; a < kept_.size(); ++a) {
    const BlockPattern::Group& group = pattern_.groups()[a];
    kept_[a] = {0, count_};
    for (std::size_t row = group.first; row < group.first + group.size; ++row) {
      const bool counts =
          are_all_ || std::binary_search(chosen_.begin(), chosen_.end(), static_cast<Index>(row));
      if (counts) source_[group.first + kept_[a].count++] = row;
    }
    count_ += kept_[a].count;
  }
}

bool SchurComplement::decompose(const Matrix& mass, const Matrix& gradient, const std::vector<Index>* rows) {
  const auto n = static_cast<std::size_t>(mass.rows());
  const auto g = static_cast<std::size_t>(gradient.rows());
  if (n != pattern_.velocities() || g != pattern_.rows()) set_pattern(BlockPattern::dense(n, g));
  set_rows(rows);
  return with_size(pattern_.block(), [&](auto size) {
    if (!decompose_mass(mass, size) || !set_images(gradient, size)) return false;
    multiply_images(size);
    return decompose_complement();
  });
}

/// Copies the lower triangles of the blocks of M. @return  whether they differ from the last ones
template <class Size>
bool SchurComplement::copy_mass(const Matrix& mass, Size size) {
  const std::size_t n = pattern_.velocities();
  bool differ = false;
  for (std::size_t first = 0; first < n; first += size) {
    double* const rows = triangles_.data() + first * size;
    for (std::size_t j = 0; j < size; ++j) {
      const double* const column = mass.data() + (first + j) * n + first;
      for (std::size_t i = j; i < size; ++i) {
        differ |= rows[i * size + j] != column[i];
        rows[i * size + j] = column[i];
      }
    }
  }
  return differ;
}

/// M is often constant, and always the same in the projections of a state.
template <class Size>
bool SchurComplement::decompose_mass(const Matrix& mass, Size size) {
  if (!copy_mass(mass, size) && is_mass_decomposed_) return true;
  is_mass_decomposed_ = false;
  mass_ = triangles_;
  regularity_ = 1;
  WorkSpace<Size> work(of_row_);
  for (std::size_t block = 0; block < pattern_.blocks(); ++block) {
    const std::size_t first = block * size;
    double* const rows = mass_.data() + first * size;
    double* const diagonal = velocities_.data() + first;
    double others = 0;  // off the diagonal
    for (std::size_t i = 0; i < size; ++i) {
      diagonal[i] = rows[i * size + i];
      for (std::size_t j = 0; j < i; ++j) others += std::abs(rows[i * size + j]);
    }
    is_diagonal_[block] = others == 0;
    const double least =
        pivots(rows, size, size, diagonal, inverse_mass_.data() + first, work.data(), least_pivot);
    if (!(least > 0)) return false;
    regularity_ = std::min(regularity_, least);
  }
  is_mass_decomposed_ = true;
  return true;
}

/// The rows L^-1 C_b^T. @return  false if two rows are nearly all one velocity's
template <class Size>
bool SchurComplement::set_images(const Matrix& gradient, Size size) {
  ties_.clear();
  for (std::size_t a = 0; a < kept_.size(); ++a) {
    const BlockPattern::Group& group = pattern_.groups()[a];
    for (const BlockPattern::Entry& entry : group.entries) {
      const double* const of_mass = mass_.data() + entry.block * size * size;
      const double* const inverse = inverse_mass_.data() + entry.block * size;
      const double* const columns = gradient.data() + entry.block * size * pattern_.rows();
      for (std::size_t i = 0; i < kept_[a].count; ++i) {
        const std::size_t place = entry.place + i * size;
        double* const image = images_.data() + place;
        for (std::size_t s = 0; s < size; ++s) {
          rows_[place + s] = image[s] = columns[s * pattern_.rows() + source_[group.first + i]];
        }
        if (!is_diagonal_[entry.block]) solve_lower(of_mass, size, size, image);
        for (std::size_t s = 0; s < size; ++s) weighted_[place + s] = image[s] * inverse[s];
      }
    }
    for (std::size_t i = 0; i < kept_[a].count; ++i) {
      if (!set_tie(a, i, size)) return false;
    }
  }
  return true;
}

/// @return  false if another row is nearly all the velocity's, too, that this one is
template <class Size>
bool SchurComplement::set_tie(std::size_t group, std::size_t row, Size size) {
  // Squares of the parts of the row, in the metric of M.
  double sum = 0;
  double most = 0;
  for (const BlockPattern::Entry& entry : pattern_.groups()[group].entries) {
    const double* const numbers = rows_.data() + entry.place + row * size;
    const double* const inverse = inverse_mass_.data() + entry.block * size;
    for (std::size_t s = 0; s < size; ++s) {
      const double square = numbers[s] * numbers[s] * inverse[s];
      sum += square;
      most = std::max(most, square);
    }
  }
  constexpr double part = least_pivot * least_pivot;
  if (most < (1 - 2 * part) * sum) return true;
  double others = 0;
  std::size_t heaviest = pattern_.velocities();
  for (const BlockPattern::Entry& entry : pattern_.groups()[group].entries) {
    const double* const numbers = rows_.data() + entry.place + row * size;
    for (std::size_t s = 0; s < size; ++s) {
      const std::size_t velocity = entry.block * size + s;
      const double square = numbers[s] * numbers[s] * inverse_mass_[velocity];
      if (square == most && heaviest == pattern_.velocities()) {
        heaviest = velocity;
      } else {
        others += square;
      }
    }
  }
  if (!(others > 0 && others < part * most)) return true;
  for (const Tie& other : ties_) {
    if (other.velocity == heaviest) return false;
  }
  ties_.push_back({group, row, heaviest});
  return true;
}

/// C M^-1 C^T.
template <class Size>
void SchurComplement::multiply_images(Size size) {
  std::fill(complement_.begin(), complement_.end(), 0);
  for (const BlockPattern::Product& product : pattern_.products()) {
    const std::size_t stride = pattern_.groups()[product.columns].size;
    const std::size_t columns = kept_[product.columns].count;
    const bool is_diagonal = product.rows == product.columns;
    for (std::size_t i = 0; i < kept_[product.rows].count; ++i) {
      const double* const image = images_.data() + product.rows_place + i * size;
      const double* weighted = weighted_.data() + product.columns_place;
      double* const row = complement_.data() + product.place + i * stride;
      for (std::size_t j = 0; j < (is_diagonal ? i + 1 : columns); ++j, weighted += size) {
        row[j] += dot_in_pairs(image, weighted, size);
      }
      if (is_diagonal) diagonal_[pattern_.groups()[product.rows].first + i] = row[i];
    }
  }
}

bool SchurComplement::decompose_complement() {
  for (const std::size_t a : pattern_.order()) {
    if (!with_size(kept_[a].count, [&](auto size) { return eliminate(a, size); })) return false;
  }
  return true;
}

/// Decomposes the columns of a group, and takes their part off the others.
template <class Size>
bool SchurComplement::eliminate(std::size_t a, Size size) {
  const BlockPattern::Group& group = pattern_.groups()[a];
  double* const triangle = complement_.data() + group.diagonal;
  double* const inverse = inverse_complement_.data() + group.first;
  WorkSpace<Size> work(of_row_);
  if (!(pivots(triangle, group.size, size, diagonal_.data() + group.first, inverse, work.data(),
               least_pivot) > 0)) {
    return false;
  }
  for (const BlockPattern::Coupling& coupling : group.couplings) {
    for (std::size_t i = 0; i < kept_[coupling.group].count; ++i) {
      double* const row = complement_.data() + coupling.place + i * group.size;
      double* const scaled = scaled_.data() + coupling.place + i * group.size;  // of L D
      std::copy_n(row, std::size_t(size), scaled);
      solve_lower(triangle, group.size, size, scaled);
      for (std::size_t s = 0; s < size; ++s) row[s] = scaled[s] * inverse[s];
    }
  }
  const std::size_t* fill = group.fill.data();
  for (std::size_t i = 0; i < group.couplings.size(); ++i) {
    const BlockPattern::Coupling& below = group.couplings[i];
    for (std::size_t j = 0; j <= i; ++j) {
      const BlockPattern::Coupling& other = group.couplings[j];
      double* const numbers = complement_.data() + *fill++;
      const std::size_t stride = pattern_.groups()[other.group].size;
      for (std::size_t r = 0; r < kept_[below.group].count; ++r) {
        const double* const row = complement_.data() + below.place + r * group.size;
        const std::size_t end = i == j ? r + 1 : kept_[other.group].count;
        for (std::size_t c = 0; c < end; ++c) {
          numbers[r * stride + c] -= dot(row, scaled_.data() + other.place + c * group.size, size, size);
        }
      }
    }
  }
  return true;
}

/// Calls function(numbers of the row, velocities of the block, row of the pattern, its number among those
/// that count) for each row of each entry.
template <class Function>
void SchurComplement::for_each_row(Function function) const {
  for (std::size_t a = 0; a < kept_.size(); ++a) {
    const BlockPattern::Group& group = pattern_.groups()[a];
    for (const BlockPattern::Entry& entry : group.entries) {
      for (std::size_t i = 0; i < kept_[a].count; ++i) {
        function(entry.place + i * pattern_.block(), entry.block * pattern_.block(), group.first + i);
      }
    }
  }
}

/// Sets the multipliers' right-hand sides from their numbers among the rows that count.
void SchurComplement::gather(const Vector& numbers) const {
  for (std::size_t a = 0; a < kept_.size(); ++a) {
    std::copy_n(numbers.data() + kept_[a].first, kept_[a].count,
                multipliers_.data() + pattern_.groups()[a].first);
  }
}

/// Calls solve(L, velocities of the block) for each block of M that is not diagonal.
template <class Size, class Solve>
void SchurComplement::solve_mass(Solve solve, Size size) const {
  for (std::size_t block = 0; block < pattern_.blocks(); ++block) {
    if (!is_diagonal_[block]) solve(mass_.data() + block * size * size, velocities_.data() + block * size);
  }
}

/// A velocity that is nearly all of a row, as that across a skate near an axis or that of a light wheel,
/// follows from the row: as a difference of forces it would lose figures.
/// @param wanted  C x (g)
template <class Size>
void SchurComplement::tie(const Vector& wanted, Size size) const {
  for (const Tie& tie : ties_) {
    velocities_[tie.velocity] = 0;
    double rest = wanted.data()[kept_[tie.group].first + tie.row];
    double slope = 1;
    for (const BlockPattern::Entry& entry : pattern_.groups()[tie.group].entries) {
      const double* const row = rows_.data() + entry.place + tie.row * size;
      const std::size_t first = entry.block * size;
      rest -= dot(row, velocities_.data() + first, size, size);
      if (tie.velocity >= first && tie.velocity < first + size) slope = row[tie.velocity - first];
    }
    velocities_[tie.velocity] = rest / slope;
  }
}

void SchurComplement::solve_complement() const {
  double* const y = multipliers_.data();
  for (const std::size_t a : pattern_.order()) {
    with_size(kept_[a].count, [&](auto size) {
      const BlockPattern::Group& group = pattern_.groups()[a];
      double* const own = y + group.first;
      solve_lower(complement_.data() + group.diagonal, group.size, size, own);
      for (const BlockPattern::Coupling& coupling : group.couplings) {
        const double* row = complement_.data() + coupling.place;
        double* const other = y + pattern_.groups()[coupling.group].first;
        for (std::size_t i = 0; i < kept_[coupling.group].count; ++i, row += group.size) {
          other[i] -= dot(row, own, size, size);
        }
      }
      for (std::size_t i = 0; i < size; ++i) own[i] *= inverse_complement_[group.first + i];
    });
  }
  for (std::size_t turn = pattern_.order().size(); turn-- > 0;) {
    const std::size_t a = pattern_.order()[turn];
    with_size(kept_[a].count, [&](auto size) {
      const BlockPattern::Group& group = pattern_.groups()[a];
      double* const own = y + group.first;
      for (const BlockPattern::Coupling& coupling : group.couplings) {
        const double* row = complement_.data() + coupling.place;
        const double* const other = y + pattern_.groups()[coupling.group].first;
        for (std::size_t i = 0; i < kept_[coupling.group].count; ++i, row += group.size) {
          add(-other[i], row, size, own);
        }
      }
      solve_upper(complement_.data() + group.diagonal, group.size, size, own);
    });
  }
}

bool SchurComplement::solve(const Vector& h, const Vector& gamma, Vector& x, Vector& y) const {
  return with_size(pattern_.block(), [&](auto size) {
    std::copy_n(h.data(), velocities_.size(), velocities_.data());
    solve_mass([size](auto L, auto x) { solve_lower(L, size, size, x); }, size);
    gather(gamma);
    for_each_row([&](std::size_t place, std::size_t first, std::size_t row) {
      multipliers_[row] -= dot(weighted_.data() + place, velocities_.data() + first, size, size);
    });
    solve_complement();
    for_each_row([&](std::size_t place, std::size_t first, std::size_t row) {
      add(multipliers_[row], images_.data() + place, size, velocities_.data() + first);
    });
    for (std::size_t s = 0; s < velocities_.size(); ++s) velocities_[s] *= inverse_mass_[s];
    solve_mass([size](auto L, auto x) { solve_upper(L, size, size, x); }, size);
    tie(gamma, size);
    return give(x, y);
  });
}

bool SchurComplement::give(Vector& x, Vector& y) const {
  double zero = 0;
  for (const double number : velocities_) zero += 0 * number;
  for (std::size_t a = 0; a < kept_.size(); ++a) {
    const double* const numbers = multipliers_.data() + pattern_.groups()[a].first;
    for (std::size_t i = 0; i < kept_[a].count; ++i) zero += 0 * numbers[i];
  }
  if (zero != 0 || std::isnan(zero)) return false;
  x.resize(static_cast<Index>(velocities_.size()));
  std::copy(velocities_.begin(), velocities_.end(), x.data());
  y.resize(static_cast<Index>(count_));
  for (std::size_t a = 0; a < kept_.size(); ++a) {
    std::copy_n(multipliers_.data() + pattern_.groups()[a].first, kept_[a].count, y.data() + kept_[a].first);
  }
  return true;
}

void SchurComplement::add_shortest(const Vector& missing, Vector& x) const {
  with_size(pattern_.block(), [&](auto size) {
    gather(missing);
    solve_complement();
    std::fill(velocities_.begin(), velocities_.end(), 0);
    for_each_row([&](std::size_t place, std::size_t first, std::size_t row) {
      add(multipliers_[row], weighted_.data() + place, size, velocities_.data() + first);
    });
    solve_mass([size](auto L, auto x) { solve_upper(L, size, size, x); }, size);
    tie(missing, size);
  });
  for (std::size_t s = 0; s < velocities_.size(); ++s) x.data()[s] += velocities_[s];
}

// The length, in the metric of M^-1, of what is left of e_i off the rows of C.
double SchurComplement::mobility(Index i) const {
  std::fill(velocities_.begin(), velocities_.end(), 0);
  velocities_[static_cast<std::size_t>(i)] = 1;
  std::fill(multipliers_.begin(), multipliers_.end(), 0);
  with_size(pattern_.block(), [&](auto size) {
    solve_mass([size](auto L, auto x) { solve_lower(L, size, size, x); }, size);
    for_each_row([&](std::size_t place, std::size_t first, std::size_t row) {
      multipliers_[row] += dot(weighted_.data() + place, velocities_.data() + first, size, size);
    });
    solve_complement();
    for_each_row([&](std::size_t place, std::size_t first, std::size_t row) {
      add(-multipliers_[row], images_.data() + place, size, velocities_.data() + first);
    });
  });
  double square = 0;
  for (std::size_t s = 0; s < velocities_.size(); ++s) {
    square += velocities_[s] * velocities_[s] * inverse_mass_[s];
  }
  return std::sqrt(square);
}

}  // namespace hybrid_sphere::mechanics
