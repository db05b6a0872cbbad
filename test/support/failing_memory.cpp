#include "support/failing_memory.hpp"

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace hybrid_sphere::testing::memory {
namespace {

bool armed = false;
bool failed = false;
std::size_t taken = 0;  // since armed
std::size_t from = 0;
std::size_t to = 0;
long blocks = 0;

}  // namespace

void fail(std::size_t first, std::size_t count) {
  from = first;
  to = count > std::numeric_limits<std::size_t>::max() - first ? std::numeric_limits<std::size_t>::max()
                                                               : first + count;
  taken = 0;
  failed = false;
  armed = true;
}

bool stop() {
  armed = false;
  return failed;
}

long live() { return blocks; }

namespace {

/// Whether the allocation that is asked for is one that fails.
bool fails() {
  if (!armed) return false;
  ++taken;
  if (taken < from || taken >= to) return false;
  failed = true;
  errno = ENOMEM;
  return true;
}

void* counted(void* block) {
  if (block != nullptr) ++blocks;
  return block;
}

}  // namespace

extern "C" {

// Of glibc: what its own malloc is made of.
void* __libc_malloc(std::size_t size);                           // NOLINT(bugprone-reserved-identifier)
void* __libc_calloc(std::size_t count, std::size_t size);        // NOLINT(bugprone-reserved-identifier)
void* __libc_realloc(void* block, std::size_t size);             // NOLINT(bugprone-reserved-identifier)
void* __libc_memalign(std::size_t alignment, std::size_t size);  // NOLINT(bugprone-reserved-identifier)
void __libc_free(void* block);                                   // NOLINT(bugprone-reserved-identifier)

void* malloc(std::size_t size) { return fails() ? nullptr : counted(__libc_malloc(size)); }
void* calloc(std::size_t count, std::size_t size) {
  return fails() ? nullptr : counted(__libc_calloc(count, size));
}
void* realloc(void* block, std::size_t size) {
  if (fails()) return nullptr;
  void* grown = __libc_realloc(block, size);
  return block == nullptr ? counted(grown) : grown;
}
void* memalign(std::size_t alignment, std::size_t size) {
  return fails() ? nullptr : counted(__libc_memalign(alignment, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  void* taken_block = memalign(alignment, size);
  if (taken_block == nullptr) return ENOMEM;
  *block = taken_block;
  return 0;
}
void free(void* block) {
  if (block != nullptr) --blocks;
  __libc_free(block);
}

}  // extern "C"

}  // namespace hybrid_sphere::testing::memory
