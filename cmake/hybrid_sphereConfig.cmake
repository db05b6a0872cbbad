# find_package(hybrid_sphere): the targets hybrid_sphere::sphere and hybrid_sphere::mechanics.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 NO_MODULE)
include(${CMAKE_CURRENT_LIST_DIR}/hybrid_sphereTargets.cmake)
