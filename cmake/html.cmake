# Pages of a run (simulate --html). three.js is taken into the library as Debian ships it; without it pages are refused.
find_file(HYBRID_SPHERE_THREE_FILE three.min.js PATHS /usr/share/javascript/three NO_DEFAULT_PATH)
find_file(HYBRID_SPHERE_THREE_CONTROLS_FILE OrbitControls.js
  PATHS /usr/share/javascript/three/examples/js/controls NO_DEFAULT_PATH)
mark_as_advanced(HYBRID_SPHERE_THREE_FILE HYBRID_SPHERE_THREE_CONTROLS_FILE)

set(HYBRID_SPHERE_PAGE_FOLDER ${PROJECT_SOURCE_DIR}/src/html)
set(page_scripts
  page_numbers.js
  page_data.js
  page_motion.js
  page_ground.js
  page_labels.js
  page_marks.js
  page_ball.js
  page_view.js
  page_plots.js
  page_timeline.js
  page_table.js
  page_legend.js
  page_main.js)
list(TRANSFORM page_scripts PREPEND ${HYBRID_SPHERE_PAGE_FOLDER}/)
set(page_folder ${PROJECT_BINARY_DIR}/html)
set(HYBRID_SPHERE_PAGE_SCRIPT ${page_folder}/page.js)
if(HYBRID_SPHERE_THREE_FILE AND HYBRID_SPHERE_THREE_CONTROLS_FILE)
  set(HYBRID_SPHERE_WRITES_PAGES ON)
  set(HYBRID_SPHERE_THREE ${HYBRID_SPHERE_THREE_FILE})
  set(HYBRID_SPHERE_THREE_CONTROLS ${HYBRID_SPHERE_THREE_CONTROLS_FILE})
else()
  message(STATUS "simulate --html is left out: three.js is missing; scripts/install_dependencies core installs libjs-three")
  set(HYBRID_SPHERE_THREE ${page_folder}/no_three.js)
  set(HYBRID_SPHERE_THREE_CONTROLS ${page_folder}/no_three.js)
endif()
file(MAKE_DIRECTORY ${page_folder})
file(WRITE ${page_folder}/no_three.js "")
add_custom_command(OUTPUT ${HYBRID_SPHERE_PAGE_SCRIPT}
  COMMAND cat ${page_scripts} > ${HYBRID_SPHERE_PAGE_SCRIPT}
  DEPENDS ${page_scripts} VERBATIM)
configure_file(${HYBRID_SPHERE_PAGE_FOLDER}/embedded.cpp.in ${page_folder}/embedded.cpp @ONLY)
set_source_files_properties(${page_folder}/embedded.cpp PROPERTIES
  SKIP_PRECOMPILE_HEADERS ON
  OBJECT_DEPENDS "${HYBRID_SPHERE_PAGE_FOLDER}/page.html;${HYBRID_SPHERE_PAGE_FOLDER}/page.css;${HYBRID_SPHERE_PAGE_FOLDER}/three_licence.txt;${HYBRID_SPHERE_PAGE_SCRIPT};${HYBRID_SPHERE_THREE};${HYBRID_SPHERE_THREE_CONTROLS}")

hybrid_sphere_part(html
  src/html/cell_raster.cpp
  src/html/drawn_ground.cpp
  src/html/json.cpp
  src/html/page.cpp
  src/html/page_data.cpp
  src/html/recording.cpp
  src/html/rings.cpp
  ${page_folder}/embedded.cpp)
target_link_libraries(hybrid_sphere_html_part PUBLIC hybrid_sphere_core_part)
