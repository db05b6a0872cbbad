# Nothing is installed of what another project builds in a folder of its own.
if(HYBRID_SPHERE_CORE_ONLY AND NOT PROJECT_SOURCE_DIR STREQUAL CMAKE_SOURCE_DIR)
  return()
endif()

# The libraries, their headers and what finds them, and the programs without ROS: with ROS where catkin looks for them.
if(HYBRID_SPHERE_CORE_ONLY)
  set(library_destination ${CMAKE_INSTALL_LIBDIR})
  set(program_destination ${CMAKE_INSTALL_BINDIR})
  set(include_destination ${CMAKE_INSTALL_INCLUDEDIR})
  set(config_destination ${CMAKE_INSTALL_LIBDIR}/cmake/hybrid_sphere)
else()
  set(library_destination ${CATKIN_PACKAGE_LIB_DESTINATION})
  set(program_destination ${CATKIN_PACKAGE_BIN_DESTINATION})
  set(include_destination ${CATKIN_GLOBAL_INCLUDE_DESTINATION})
  # Where catkin puts its own.
  if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
    set(config_destination ${CATKIN_GLOBAL_LIB_DESTINATION}/cmake/hybrid_sphere)
  else()
    set(config_destination ${CATKIN_PACKAGE_SHARE_DESTINATION}/cmake)
  endif()
endif()
install(TARGETS hybrid_sphere_core hybrid_sphere_mechanics EXPORT hybrid_sphereTargets
  LIBRARY DESTINATION ${library_destination} COMPONENT library)
install(TARGETS simulate three_stage
  RUNTIME DESTINATION ${program_destination})
if(TARGET study)
  install(TARGETS study
    RUNTIME DESTINATION ${program_destination})
endif()
install(DIRECTORY include/hybrid_sphere
  DESTINATION ${include_destination} COMPONENT library)
install(EXPORT hybrid_sphereTargets NAMESPACE hybrid_sphere::
  DESTINATION ${config_destination} COMPONENT library)
if(HYBRID_SPHERE_CORE_ONLY)
  include(CMakePackageConfigHelpers)
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/hybrid_sphereConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
  #catkin_lint: ignore_once missing_file
  install(FILES cmake/hybrid_sphereConfig.cmake ${PROJECT_BINARY_DIR}/hybrid_sphereConfigVersion.cmake
    DESTINATION ${config_destination} COMPONENT library)
else()
  # For packages that build against the devel space.
  export(EXPORT hybrid_sphereTargets NAMESPACE hybrid_sphere::
    FILE ${CATKIN_DEVEL_PREFIX}/share/hybrid_sphere/cmake/hybrid_sphereTargets.cmake)
endif()
