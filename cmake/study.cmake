# The program `study`: many runs of one scene, on one core or a cluster. It needs MPI, HDF5 and Random123, which nothing
# else does: it is left out where one is missing.
option(HYBRID_SPHERE_STUDY "Build the program study, where MPI, HDF5 and Random123 are there" ON)
if(NOT HYBRID_SPHERE_STUDY OR HYBRID_SPHERE_FUZZ)
  return()
endif()
find_package(MPI QUIET COMPONENTS CXX)
find_package(hdf5_serial MODULE QUIET)
find_path(random123_INCLUDE_DIR Random123/philox.h)
mark_as_advanced(random123_INCLUDE_DIR)
if(NOT MPI_CXX_FOUND OR NOT hdf5_serial_FOUND OR NOT random123_INCLUDE_DIR)
  message(STATUS "study is left out: MPI, HDF5 or Random123 is missing; scripts/install_dependencies study installs them")
  return()
endif()

find_package(ZLIB REQUIRED)  # which libpng needs, too

# All read Boost.Math or the Sobol sequence of Boost.Random, which cost more than all else in them.
set_source_files_properties(src/study/distribution.cpp src/study/require_valid.cpp src/study/sampler.cpp
  src/study/statistics.cpp src/study/truncated_normal.cpp PROPERTIES UNITY_GROUP boost)
hybrid_sphere_part(study
  src/study/analysis.cpp
  src/study/chunk.cpp
  src/study/columns.cpp
  src/study/compute.cpp
  src/study/distribution.cpp
  src/study/experiment.cpp
  src/study/hdf5.cpp
  src/study/journal.cpp
  src/study/order_statistics.cpp
  src/study/permutation.cpp
  src/study/read_correlation.cpp
  src/study/read_distribution.cpp
  src/study/read_study.cpp
  src/study/require_valid.cpp
  src/study/results.cpp
  src/study/results_file.cpp
  src/study/sampler.cpp
  src/study/samples.cpp
  src/study/sobol_indices.cpp
  src/study/statistics.cpp
  src/study/study_scene.cpp
  src/study/team.cpp
  src/study/truncated_normal.cpp)
target_link_libraries(hybrid_sphere_study_part PUBLIC hybrid_sphere_core_part
  PRIVATE MPI::MPI_CXX hdf5_serial::hdf5_serial ZLIB::ZLIB)
target_include_directories(hybrid_sphere_study_part SYSTEM PRIVATE ${random123_INCLUDE_DIR})
target_compile_definitions(hybrid_sphere_study_part PRIVATE HYBRID_SPHERE_VERSION="${PROJECT_VERSION}"
  OMPI_SKIP_MPICXX MPICH_SKIP_MPICXX)

add_library(hybrid_sphere_study STATIC
  src/cli/study_options.cpp
  src/cli/study_processes.cpp
  src/cli/study_report.cpp
  src/cli/study_run.cpp)
target_link_libraries(hybrid_sphere_study PUBLIC hybrid_sphere_study_part hybrid_sphere_cli)
hybrid_sphere_own(hybrid_sphere_study)
hybrid_sphere_cold(hybrid_sphere_study)

add_executable(study src/cli/study_main.cpp)
target_link_libraries(study PRIVATE hybrid_sphere_study)
hybrid_sphere_own(study)
