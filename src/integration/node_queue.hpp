#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "integration/integrator.hpp"

namespace hybrid_sphere::integration {

/// The nodes of a trajectory, added at the end and dropped at the beginning. They are stored in blocks, so
/// that no node moves when millions follow it; the blocks of dropped nodes are reused.
class NodeQueue {
 public:
  std::size_t size() const { return end_ - first_; }
  const Node& operator[](std::size_t i) const { return block_of(first_ + i)[(first_ + i) % length]; }
  Node& operator[](std::size_t i) { return const_cast<Node&>(std::as_const(*this)[i]); }
  const Node& back() const { return (*this)[size() - 1]; }
  Node& back() { return (*this)[size() - 1]; }

  /// Adds a node at the end; the others are not moved.
  void push_back(Node node);
  /// Drops the first nodes, at most size().
  void pop_front(std::size_t count);
  /// Drops all nodes. release() frees the memory of more than a few thousand.
  void clear();
  /// Frees up to this many blocks left over by clear(). Freeing millions of nodes takes the system half a
  /// second, for which nobody should have to wait at once.
  void release(std::size_t blocks) {
    if (!left_.empty()) give_back(blocks);
  }

 private:
  using Block = std::vector<Node>;
  static constexpr std::size_t length = 64;  ///< of a block

  void give_back(std::size_t blocks);
  const Block& block_of(std::size_t place) const { return blocks_[place / length]; }

  std::vector<Block> blocks_;
  std::vector<Block> left_;
  std::size_t first_ = 0;  ///< place of the first node, counted from the first block
  std::size_t end_ = 0;    ///< place after the last node
};

}  // namespace hybrid_sphere::integration
