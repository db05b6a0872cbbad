# The code of docs/your_own_system.md, as the page has it.
set(page ${CMAKE_CURRENT_BINARY_DIR}/your_own_system)
set(page_files sledge.hpp sledge.cpp steered.cpp live.cpp wheel.cpp variants.cpp bicycle.cpp door.cpp plank.cpp gears.cpp plot_sledge.py
  sledge.expected.txt steered.expected.txt wheel.expected.txt variants.expected.txt bicycle.expected.txt
  door.expected.txt plank.expected.txt gears.expected.txt pursuit.expected.txt
  catkin/CMakeLists.txt plain/CMakeLists.txt without_ros/CMakeLists.txt)
list(TRANSFORM page_files PREPEND ${page}/)
add_custom_command(
  OUTPUT ${page_files}
  COMMAND ${python_of_tests} ${CMAKE_CURRENT_SOURCE_DIR}/core/docs/extract_code.py
    ${PROJECT_SOURCE_DIR}/docs/your_own_system.md ${page}
  DEPENDS core/docs/extract_code.py ${PROJECT_SOURCE_DIR}/docs/your_own_system.md)
# The same for docs/cpp.md.
set(cpp_page ${CMAKE_CURRENT_BINARY_DIR}/cpp_page)
set(cpp_page_files ${cpp_page}/roll.cpp ${cpp_page}/CMakeLists.txt ${cpp_page}/roll.expected.txt)
add_custom_command(
  OUTPUT ${cpp_page_files}
  COMMAND ${python_of_tests} ${CMAKE_CURRENT_SOURCE_DIR}/core/docs/extract_code.py ${PROJECT_SOURCE_DIR}/docs/cpp.md ${cpp_page}
  DEPENDS core/docs/extract_code.py ${PROJECT_SOURCE_DIR}/docs/cpp.md)
add_custom_target(page_code DEPENDS ${page_files} ${cpp_page_files})
# Each installed header alone, and the example of its comments.
set(examples ${CMAKE_CURRENT_BINARY_DIR}/header_examples)
file(GLOB_RECURSE public_headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/include/hybrid_sphere
  ${PROJECT_SOURCE_DIR}/include/hybrid_sphere/*.hpp)
set(example_files ${public_headers})
list(TRANSFORM example_files REPLACE "/" "_")
list(TRANSFORM example_files REPLACE "(.+)[.]hpp" "${examples}/\\1.cpp")
list(TRANSFORM public_headers PREPEND ${PROJECT_SOURCE_DIR}/include/hybrid_sphere/)
add_custom_command(
  OUTPUT ${example_files}
  COMMAND ${python_of_tests} ${CMAKE_CURRENT_SOURCE_DIR}/core/docs/extract_examples.py ${PROJECT_SOURCE_DIR}/include ${examples}
  DEPENDS core/docs/extract_examples.py ${public_headers})
add_library(hybrid_sphere_header_examples OBJECT EXCLUDE_FROM_ALL ${example_files})
target_link_libraries(hybrid_sphere_header_examples PRIVATE hybrid_sphere::sphere hybrid_sphere::mechanics)
target_compile_options(hybrid_sphere_header_examples PRIVATE -O0 -Wall -Wextra -Wno-unused)
set_target_properties(hybrid_sphere_header_examples PROPERTIES UNITY_BUILD_BATCH_SIZE 20)
hybrid_sphere_test(docs_tests
  core/docs/cpp_page_test.cpp
  core/docs/your_own_system_test.cpp
  OWN_HEADERS
  PROPERTIES RESOURCE_LOCK docs_tests)
foreach(program sledge steered wheel variants bicycle door plank gears)
  #catkin_lint: ignore_once missing_file
  add_executable(page_${program} EXCLUDE_FROM_ALL ${page}/${program}.cpp)
  set_target_properties(page_${program} PROPERTIES OUTPUT_NAME ${program} RUNTIME_OUTPUT_DIRECTORY ${page})
  target_link_libraries(page_${program} PRIVATE hybrid_sphere::mechanics)
  hybrid_sphere_own(page_${program})
  hybrid_sphere_cold(page_${program} OWN_HEADERS)
  add_dependencies(page_${program} page_code)
endforeach()
if(TARGET hybrid_sphere_ros)
  #catkin_lint: ignore_once missing_file
  add_library(page_live SHARED EXCLUDE_FROM_ALL ${page}/live.cpp)
  target_include_directories(page_live SYSTEM PRIVATE ${catkin_INCLUDE_DIRS})
  target_link_libraries(page_live PRIVATE hybrid_sphere::mechanics ${catkin_LIBRARIES})
  hybrid_sphere_own(page_live)
  hybrid_sphere_cold(page_live OWN_HEADERS)
  set_target_properties(page_live PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${page})
  add_dependencies(page_live page_code)
  if(TARGET tests)
    add_dependencies(tests page_live)
  endif()
endif()
add_dependencies(docs_tests page_code page_sledge page_steered page_wheel page_variants page_bicycle page_door page_plank page_gears pursuit hybrid_sphere_core
  hybrid_sphere_header_examples)
target_compile_definitions(docs_tests PRIVATE
  BINARY_DIRECTORY="${PROJECT_BINARY_DIR}"
  CPP_PAGE_DIRECTORY="${cpp_page}"
  PAGE_DIRECTORY="${page}"
  PURSUIT="$<TARGET_FILE:pursuit>"
  PYTHON="${python_of_tests}"
  SOURCE_DIRECTORY="${PROJECT_SOURCE_DIR}")
if(HYBRID_SPHERE_NODE)
  target_compile_definitions(docs_tests PRIVATE DEVEL_DIRECTORY="${CATKIN_DEVEL_PREFIX}")
  add_dependencies(docs_tests hybrid_sphere_ros)
endif()
