#include "mechanics/block_pattern.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace hybrid_sphere::mechanics {

BlockPattern BlockPattern::dense(std::size_t n, std::size_t g) {
  BlockPattern pattern;
  pattern.block_ = n;
  pattern.blocks_ = 1;
  if (g > 0) pattern.add_group(g, {0});
  pattern.finish();
  return pattern;
}

BlockPattern BlockPattern::of(const Model& model, const ActiveSet& active) {
  const auto n = static_cast<std::size_t>(model.equations->velocities());
  std::size_t g = 0;
  for (const std::size_t i : active) g += static_cast<std::size_t>(model.constraints[i].function->size());
  const auto block = static_cast<std::size_t>(model.equations->mass_block());
  if (block == 0 || block >= n || n % block != 0) return dense(n, g);
  BlockPattern pattern;
  pattern.block_ = block;
  pattern.blocks_ = n / block;
  for (const std::size_t i : active) {
    const ConstraintFunction& function = *model.constraints[i].function;
    std::vector<std::size_t> blocks;
    for (std::size_t s = 0; s < n; ++s) {
      const bool is_new = blocks.empty() || blocks.back() != s / block;
      if (is_new && function.depends_on(static_cast<Index>(s))) blocks.push_back(s / block);
    }
    pattern.add_group(static_cast<std::size_t>(function.size()), blocks);
  }
  pattern.finish();
  return pattern;
}

void BlockPattern::finish() {
  eliminate();
  place_blocks();
  add_products();
}

void BlockPattern::add_group(std::size_t size, const std::vector<std::size_t>& blocks) {
  Group group{size, rows_, {}, 0, {}, {}};
  for (const std::size_t block : blocks) {
    group.entries.push_back({block, entry_numbers_});
    entry_numbers_ += size * block_;
  }
  rows_ += size;
  groups_.push_back(std::move(group));
}

/// Returns the groups that share a block of M with each group.
std::vector<std::set<std::size_t>> BlockPattern::neighbours() const {
  std::vector<std::vector<std::size_t>> members(blocks_);
  for (std::size_t a = 0; a < groups_.size(); ++a) {
    for (const Entry& entry : groups_[a].entries) members[entry.block].push_back(a);
  }
  std::vector<std::set<std::size_t>> neighbours(groups_.size());
  for (const std::vector<std::size_t>& of_block : members) {
    for (const std::size_t a : of_block) neighbours[a].insert(of_block.begin(), of_block.end());
  }
  for (std::size_t a = 0; a < groups_.size(); ++a) neighbours[a].erase(a);
  return neighbours;
}

/// Sets the order, and the couplings of each group in this order.
void BlockPattern::eliminate() {
  std::vector<std::set<std::size_t>> connected = neighbours();
  std::vector<std::size_t> left(groups_.size());
  std::iota(left.begin(), left.end(), 0);
  while (!left.empty()) {
    const auto next = std::min_element(left.begin(), left.end(), [&](std::size_t a, std::size_t b) {
      return connected[a].size() < connected[b].size();
    });
    const std::size_t a = *next;
    left.erase(next);
    order_.push_back(a);
    for (const std::size_t other : connected[a]) {
      groups_[a].couplings.push_back({other, 0});
      connected[other].insert(connected[a].begin(), connected[a].end());
      connected[other].erase(other);
      connected[other].erase(a);
    }
  }
  turn_.resize(groups_.size());
  for (std::size_t i = 0; i < order_.size(); ++i) turn_[order_[i]] = i;
  for (Group& group : groups_) {
    std::sort(group.couplings.begin(), group.couplings.end(),
              [&](const Coupling& a, const Coupling& b) { return turn_[a.group] < turn_[b.group]; });
  }
}

/// Sets a place for each block of C M^-1 C^T.
void BlockPattern::place_blocks() {
  for (Group& group : groups_) {
    group.diagonal = triangle_numbers_;
    triangle_numbers_ += group.size * group.size;
    for (Coupling& coupling : group.couplings) {
      coupling.place = triangle_numbers_;
      triangle_numbers_ += group.size * groups_[coupling.group].size;
    }
  }
  for (Group& group : groups_) {
    for (std::size_t i = 0; i < group.couplings.size(); ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        group.fill.push_back(place_of(group.couplings[i].group, group.couplings[j].group));
      }
    }
  }
}

/// The place of a block of the lower triangle. @param row, column  groups
std::size_t BlockPattern::place_of(std::size_t row, std::size_t column) const {
  const Group& group = groups_[column];
  if (row == column) return group.diagonal;
  return std::find_if(group.couplings.begin(), group.couplings.end(),
                      [row](const Coupling& coupling) { return coupling.group == row; })
      ->place;
}

void BlockPattern::add_products() {
  for (std::size_t a = 0; a < groups_.size(); ++a) {
    for (std::size_t b = 0; b < groups_.size(); ++b) {
      if (turn_[b] > turn_[a]) continue;
      for (const Entry& row : groups_[a].entries) {
        for (const Entry& column : groups_[b].entries) {
          if (row.block == column.block) {
            products_.push_back({a, b, row.place, column.place, place_of(a, b)});
          }
        }
      }
    }
  }
}

}  // namespace hybrid_sphere::mechanics
