#include "hybrid_sphere/solver/node_queue.hpp"

#include <algorithm>

namespace hybrid_sphere::solver {

void NodeQueue::push_back(Node node) {
  if (end_ == length * blocks_.size()) blocks_.emplace_back().reserve(length);
  blocks_[end_ / length].push_back(std::move(node));
  ++end_;
}

void NodeQueue::pop_front(std::size_t count) {
  first_ += count;
  const std::size_t free = first_ / length;
  if (2 * free <= blocks_.size()) return;  // a block is moved once on the average
  const auto used = blocks_.begin() + static_cast<std::ptrdiff_t>(free);
  std::for_each(blocks_.begin(), used, [](Block& block) { block.clear(); });
  std::rotate(blocks_.begin(), used, blocks_.end());
  first_ -= free * length;
  end_ -= free * length;
}

void NodeQueue::clear() {
  constexpr std::size_t most_blocks = 64;
  if (blocks_.size() > most_blocks) blocks_.resize(most_blocks);
  for (Block& block : blocks_) block.clear();
  first_ = 0;
  end_ = 0;
}

}  // namespace hybrid_sphere::solver
