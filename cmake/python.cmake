# The Python module: `import hybrid_sphere`, beside the messages of the same name. For Debian's Python; left out where
# pybind11 is missing.
option(HYBRID_SPHERE_PYTHON "Build the Python module, where pybind11 is there" ON)
if(NOT HYBRID_SPHERE_PYTHON OR HYBRID_SPHERE_FUZZ OR HYBRID_SPHERE_SANITIZE OR HYBRID_SPHERE_COVERAGE)
  return()
endif()
if(NOT PYTHON_EXECUTABLE)
  find_program(PYTHON_EXECUTABLE python3 PATHS /usr/bin NO_DEFAULT_PATH)
endif()
if(NOT Python3_EXECUTABLE)
  set(Python3_EXECUTABLE ${PYTHON_EXECUTABLE})
endif()
find_package(Python3 QUIET COMPONENTS Interpreter Development.Module)
if(Python3_Development.Module_FOUND)
  find_package(pybind11 QUIET CONFIG)
endif()
if(NOT pybind11_FOUND)
  message(STATUS
    "The Python module is left out: pybind11 or python3-dev is missing; scripts/install_dependencies python installs them")
  return()
endif()

# The loops: batches of runs, and derivatives of numbers.
add_library(hybrid_sphere_python_loops OBJECT
  src/python/batch.cpp
  src/python/number.cpp)
target_link_libraries(hybrid_sphere_python_loops PRIVATE hybrid_sphere_core_part hybrid_sphere_mechanics_part)
set_target_properties(hybrid_sphere_python_loops PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
hybrid_sphere_own(hybrid_sphere_python_loops)
hybrid_sphere_precompile(hybrid_sphere_python_loops REUSE_FROM hybrid_sphere_integration_part)

add_library(hybrid_sphere_python MODULE
  src/python/body_arguments.cpp
  src/python/body_functions.cpp
  src/python/catalogue.cpp
  src/python/errors.cpp
  src/python/kept_switches.cpp
  src/python/linearize.cpp
  src/python/modes.cpp
  src/python/model_of_input.cpp
  src/python/module.cpp
  src/python/motion_arrays.cpp
  src/python/motion_request.cpp
  src/python/motion_table.cpp
  src/python/multibody.cpp
  src/python/multibody_parts.cpp
  src/python/number_arithmetic.cpp
  src/python/number_object.cpp
  src/python/number_ufunc.cpp
  src/python/numbers_of.cpp
  src/python/numpy_text.cpp
  src/python/page.cpp
  src/python/plant.cpp
  src/python/python_constraint.cpp
  src/python/python_equations.cpp
  src/python/python_function.cpp
  src/python/run_many.cpp
  src/python/scene_of.cpp
  src/python/simulation.cpp
  src/python/solution.cpp
  src/python/state_layout.cpp
  src/python/system.cpp
  src/python/system_functions.cpp
  src/python/times.cpp
  src/python/tree_of.cpp
  $<TARGET_OBJECTS:hybrid_sphere_python_loops>)
pybind11_extension(hybrid_sphere_python)
target_link_libraries(hybrid_sphere_python PRIVATE pybind11::module hybrid_sphere_core_part hybrid_sphere_html_part hybrid_sphere_catalogue)
target_compile_definitions(hybrid_sphere_python PRIVATE HYBRID_SPHERE_VERSION="${PROJECT_VERSION}")
set_target_properties(hybrid_sphere_python PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
hybrid_sphere_own(hybrid_sphere_python BATCH 17)
hybrid_sphere_cold(hybrid_sphere_python)

# In a devel space genpy puts the messages beside it, and installs both.
if(HYBRID_SPHERE_CORE_ONLY)
  set(python_directory ${PROJECT_BINARY_DIR}/python)
  set(python_destination lib/python3/dist-packages)
else()
  set(python_directory ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_PYTHON_DESTINATION})
  set(python_destination ${CATKIN_GLOBAL_PYTHON_DESTINATION})
endif()
set_target_properties(hybrid_sphere_python PROPERTIES OUTPUT_NAME _core
  LIBRARY_OUTPUT_DIRECTORY ${python_directory}/hybrid_sphere)
foreach(file __init__.py __init__.pyi _bodies.py _columns.py _errors.py py.typed)
  configure_file(src/python/hybrid_sphere/${file} ${python_directory}/hybrid_sphere/${file} COPYONLY)
endforeach()
install(TARGETS hybrid_sphere_python LIBRARY DESTINATION ${python_destination}/hybrid_sphere)
install(DIRECTORY src/python/hybrid_sphere DESTINATION ${python_destination})
