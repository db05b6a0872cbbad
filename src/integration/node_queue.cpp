#include "integration/node_queue.hpp"

#include <algorithm>
#include <iterator>

namespace hybrid_sphere::integration {

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
  constexpr std::ptrdiff_t max_blocks = 64;
  if (static_cast<std::ptrdiff_t>(blocks_.size()) > max_blocks) {
    const auto first = blocks_.begin() + max_blocks;
    left_.insert(left_.end(), std::make_move_iterator(first), std::make_move_iterator(blocks_.end()));
    blocks_.erase(first, blocks_.end());
  }
  for (Block& block : blocks_) block.clear();
  first_ = 0;
  end_ = 0;
}

// From the end, where the heap can shrink at once.
void NodeQueue::give_back(std::size_t blocks) {
  left_.resize(left_.size() - std::min(left_.size(), blocks));
  if (left_.empty()) left_.shrink_to_fit();
}

}  // namespace hybrid_sphere::integration
