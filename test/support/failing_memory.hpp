#pragma once

#include <cstddef>

/// The C library's allocations, which those of C++ and of other libraries come to, counted and made to fail.
/// One thread.
namespace hybrid_sphere::testing::memory {

/// The allocation number `first`, counted from 1 on, fails, and with it the `count` - 1 that follow it.
void fail(std::size_t first, std::size_t count);

/// No allocation fails any more. Returns whether one has failed.
bool stop();

/// Blocks that are taken and not given back.
long live();

}  // namespace hybrid_sphere::testing::memory
