# How this package's own targets are compiled.

# Reading and instantiating the headers of Eigen and ROS takes most of the time of a small file. Therefore files of a
# folder are compiled together. -DCMAKE_UNITY_BUILD=OFF compiles each file by itself.
if(NOT DEFINED CMAKE_UNITY_BUILD)
  set(CMAKE_UNITY_BUILD ON)
endif()

# Headers that most files read.
set(common_headers <Eigen/Geometry> <algorithm> <array> <cfloat> <cmath> <cstdint> <functional> <limits> <memory>
  <optional> <sstream> <stdexcept> <string> <string_view> <utility> <variant> <vector>)

# Compiles the sources of a target in batches of at most `size` files of one folder; of any folders if `mixed` is true.
# A group without a number has been given by hand; a file stays in it. The groups of all targets have the same names, as two
# targets may share a file.
function(hybrid_sphere_batches target size mixed)
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "[.]cpp$")
  foreach(source IN LISTS sources)
    get_source_file_property(group ${source} UNITY_GROUP)
    if(group AND NOT group MATCHES "_[0-9]+$")
      continue()
    endif()
    if(mixed)
      set(folder mixed)
    else()
      get_filename_component(path ${source} ABSOLUTE)
      get_filename_component(folder ${path} DIRECTORY)
      get_filename_component(folder ${folder} NAME)
    endif()
    if(NOT DEFINED count_${folder})
      set(count_${folder} 0)
    endif()
    math(EXPR batch "${count_${folder}} / ${size}")
    math(EXPR count_${folder} "${count_${folder}} + 1")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder}_${batch})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
endfunction()

# Warnings of this package's own code; the headers of others are system headers.
# BATCH: the number of files of a folder that are compiled together (default 6). Larger batches cost less in all, but more
# after a change of one file. MIXED: a batch may have files of several folders, which then share their names.
function(hybrid_sphere_own target)
  cmake_parse_arguments(ARG "MIXED" "BATCH" "" ${ARGN})
  if(NOT ARG_BATCH)
    set(ARG_BATCH 6)
  endif()
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion
    $<$<BOOL:${HYBRID_SPHERE_WERROR}>:-Werror>)
  hybrid_sphere_batches(${target} ${ARG_BATCH} ${ARG_MIXED})
endfunction()

# Headers of others that most files of a target read; REUSE_FROM TARGET: those of another one.
function(hybrid_sphere_precompile target)
  if(NOT HYBRID_SPHERE_PRECOMPILED_HEADERS)
    return()
  elseif(ARGV1 STREQUAL "REUSE_FROM")
    target_precompile_headers(${target} ${ARGN})
    get_target_property(visibility ${ARGV2} CXX_VISIBILITY_PRESET)
    if(visibility)
      set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET ${visibility} VISIBILITY_INLINES_HIDDEN ON)
    endif()
  else()
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# Code that spends its time in libraries (options, the node, bindings) is compiled with -Og, the cheapest level to compile,
# and with hidden names. GCC stores the level of optimization in precompiled headers, so that code has its own.
add_library(hybrid_sphere_cold_headers OBJECT EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/src/precompiled.cpp)
target_link_libraries(hybrid_sphere_cold_headers PRIVATE Eigen3::Eigen)
target_compile_definitions(hybrid_sphere_cold_headers PRIVATE EIGEN_MAX_ALIGN_BYTES=16 EIGEN_MAX_STATIC_ALIGN_BYTES=16)
set(cold_options -Og $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)  # which warns of nothing wrong at this level
target_compile_options(hybrid_sphere_cold_headers PRIVATE ${cold_options})
set_target_properties(hybrid_sphere_cold_headers PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
hybrid_sphere_own(hybrid_sphere_cold_headers)
hybrid_sphere_precompile(hybrid_sphere_cold_headers ${common_headers})

# OWN_HEADERS: a program, or code that is to compile as a user compiles it, reads its headers itself.
function(hybrid_sphere_cold target)
  cmake_parse_arguments(ARG "OWN_HEADERS" "" "" ${ARGN})
  target_compile_options(${target} PRIVATE ${cold_options})
  if(NOT ARG_OWN_HEADERS)
    hybrid_sphere_precompile(${target} REUSE_FROM hybrid_sphere_cold_headers)
  endif()
endfunction()

# A part is compiled once, for the programs and tests of this repository, which link it, and for the shared libraries:
# position-independent, its names hidden.
function(hybrid_sphere_part name)
  cmake_parse_arguments(ARG "" "BATCH" "" ${ARGN})
  set(part hybrid_sphere_${name}_part)
  add_library(${part} STATIC ${ARG_UNPARSED_ARGUMENTS})
  target_compile_definitions(${part} PUBLIC EIGEN_MAX_ALIGN_BYTES=16 EIGEN_MAX_STATIC_ALIGN_BYTES=16)
  set_target_properties(${part} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  hybrid_sphere_own(${part} BATCH ${ARG_BATCH})
  if(name STREQUAL "integration")
    hybrid_sphere_precompile(${part} ${common_headers} ${PROJECT_SOURCE_DIR}/src/geometry/vectors.hpp
      ${PROJECT_SOURCE_DIR}/include/hybrid_sphere/sphere/sphere.hpp)
  else()
    hybrid_sphere_precompile(${part} REUSE_FROM hybrid_sphere_integration_part)
  endif()
endfunction()
