#include "ros/node/release_memory.hpp"

#include <malloc.h>

namespace hybrid_sphere::ros_interface {

void release_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace hybrid_sphere::ros_interface
