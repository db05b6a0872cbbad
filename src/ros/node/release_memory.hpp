#pragma once

namespace hybrid_sphere::ros_interface {

/// Gives back to the system what the process has freed: of a large map that is many small pieces, which the
/// allocator would keep. Takes milliseconds.
void release_memory();

}  // namespace hybrid_sphere::ros_interface
