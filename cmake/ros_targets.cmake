# The node and its library, on top of the core.
include_directories(SYSTEM ${catkin_INCLUDE_DIRS})

# Messages of every tick, and the drawing of maps.
add_library(hybrid_sphere_ros_messages STATIC
  src/ros/conversions/conversions.cpp
  src/ros/conversions/initial_state_message.cpp
  src/ros/conversions/planar_transform.cpp
  src/ros/conversions/state_messages.cpp
  src/ros/conversions/surface_grid.cpp
  src/ros/conversions/surface_message.cpp
  src/ros/conversions/tool_messages.cpp
  src/ros/conversions/world_coordinates.cpp
  src/ros/markers/ball_mesh.cpp
  src/ros/markers/cell_outline.cpp
  src/ros/markers/ground_motion.cpp
  src/ros/markers/region_names.cpp
  src/ros/markers/slip_arrow.cpp
  src/ros/markers/sphere_markers.cpp
  src/ros/markers/surface_labels.cpp
  src/ros/markers/surface_markers.cpp
  src/ros/markers/surface_outline.cpp
  src/ros/markers/top_grid.cpp
  src/ros/markers/triangulate.cpp
  src/ros/view/followed_view.cpp
  src/ros/view/scene_framing.cpp)
target_link_libraries(hybrid_sphere_ros_messages PUBLIC hybrid_sphere_core_part ${catkin_LIBRARIES})
add_dependencies(hybrid_sphere_ros_messages ${${PROJECT_NAME}_EXPORTED_TARGETS} ${catkin_EXPORTED_TARGETS})
hybrid_sphere_own(hybrid_sphere_ros_messages BATCH 12 MIXED)
hybrid_sphere_precompile(hybrid_sphere_ros_messages REUSE_FROM hybrid_sphere_integration_part)

add_library(hybrid_sphere_ros STATIC
  src/ros/node/callback_queue_call.cpp
  src/ros/node/callback_thread.cpp
  src/ros/node/clock_publisher.cpp
  src/ros/node/command.cpp
  src/ros/node/computation.cpp
  src/ros/node/drag_handle.cpp
  src/ros/node/driven_plant.cpp
  src/ros/node/drop_log.cpp
  src/ros/node/followed_clock.cpp
  src/ros/node/frame_transformer.cpp
  src/ros/node/guarded_queue.cpp
  src/ros/node/map_drawer.cpp
  src/ros/node/map_server.cpp
  src/ros/node/parameters.cpp
  src/ros/node/plant.cpp
  src/ros/node/real_time.cpp
  src/ros/node/reconfigure.cpp
  src/ros/node/release_memory.cpp
  src/ros/node/run_node.cpp
  src/ros/node/run_simulator.cpp
  src/ros/node/rviz_tools.cpp
  src/ros/node/scene_file.cpp
  src/ros/node/simulator_node.cpp
  src/ros/node/simulator_services.cpp
  src/ros/node/sphere_requests.cpp
  src/ros/node/state_publisher.cpp
  src/ros/node/status_publisher.cpp
  src/ros/node/switch_log.cpp
  src/ros/node/tick_clock.cpp
  src/ros/node/time_loop.cpp
  src/ros/node/time_services.cpp
  src/ros/view/view_publisher.cpp)
target_link_libraries(hybrid_sphere_ros PUBLIC hybrid_sphere_ros_messages)
hybrid_sphere_own(hybrid_sphere_ros BATCH 16 MIXED)
hybrid_sphere_cold(hybrid_sphere_ros)

# Runs of `simulate` as bags: loaded by it when it is asked for one.
add_library(hybrid_sphere_bag SHARED src/ros/bag/bag_writer.cpp)
target_include_directories(hybrid_sphere_bag SYSTEM PRIVATE ${rosbag_storage_INCLUDE_DIRS})
target_link_libraries(hybrid_sphere_bag PRIVATE hybrid_sphere_ros ${rosbag_storage_LIBRARIES})
hybrid_sphere_own(hybrid_sphere_bag)
hybrid_sphere_precompile(hybrid_sphere_bag REUSE_FROM hybrid_sphere_integration_part)
target_link_libraries(simulate PRIVATE ${CMAKE_DL_LIBS})
add_dependencies(simulate hybrid_sphere_bag)
set_target_properties(simulate PROPERTIES BUILD_RPATH $<TARGET_FILE_DIR:hybrid_sphere_bag>)

add_executable(hybrid_sphere_node src/ros/node/node_main.cpp)
target_link_libraries(hybrid_sphere_node PRIVATE hybrid_sphere_ros)
hybrid_sphere_own(hybrid_sphere_node)

# Any system: of the catalogue, and of plugins.
add_library(hybrid_sphere_ros_system STATIC
  src/ros/system/body_trail.cpp
  src/ros/system/catalogue_bodies.cpp
  src/ros/system/catalogue_system.cpp
  src/ros/system/constraint_markers.cpp
  src/ros/system/find_system.cpp
  src/ros/system/run_system.cpp
  src/ros/system/system_messages.cpp
  src/ros/system/system_node.cpp
  src/ros/system/system_parameters.cpp
  src/ros/system/system_plant.cpp)
target_link_libraries(hybrid_sphere_ros_system PUBLIC hybrid_sphere_ros hybrid_sphere_catalogue)
hybrid_sphere_own(hybrid_sphere_ros_system BATCH 10)
hybrid_sphere_cold(hybrid_sphere_ros_system)
add_executable(three_stage_node src/ros/system/three_stage_node_main.cpp)
target_link_libraries(three_stage_node PRIVATE hybrid_sphere_ros_system)
hybrid_sphere_own(three_stage_node)

# Records what a node sends.
add_executable(record src/ros/bag/record_main.cpp src/ros/bag/recorder.cpp)
target_include_directories(record SYSTEM PRIVATE ${rosbag_storage_INCLUDE_DIRS} ${topic_tools_INCLUDE_DIRS})
target_link_libraries(record PRIVATE hybrid_sphere_cli ${rosbag_storage_LIBRARIES}
  ${topic_tools_LIBRARIES} ${catkin_LIBRARIES})
hybrid_sphere_own(record)
hybrid_sphere_cold(record OWN_HEADERS)

add_library(hybrid_sphere_nodelet SHARED src/ros/node/simulator_nodelet.cpp)
target_link_libraries(hybrid_sphere_nodelet PRIVATE hybrid_sphere_ros)
# Where pluginlib looks in a devel space, also when the libraries are to be installed below lib/<architecture>.
set_target_properties(hybrid_sphere_nodelet PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/lib)
hybrid_sphere_own(hybrid_sphere_nodelet)
hybrid_sphere_cold(hybrid_sphere_nodelet)

add_executable(steer_to_target examples/steer_to_target.cpp)
target_link_libraries(steer_to_target PRIVATE ${catkin_LIBRARIES})
add_dependencies(steer_to_target ${${PROJECT_NAME}_EXPORTED_TARGETS} ${catkin_EXPORTED_TARGETS})
hybrid_sphere_own(steer_to_target)
hybrid_sphere_cold(steer_to_target OWN_HEADERS)

# Benchmarks are run where they are built.
#catkin_lint: ignore uninstalled_target
if(HYBRID_SPHERE_BENCHMARKS)
  foreach(program bare_publisher bare_listener timing_probe)
    add_executable(${program} benchmark/${program}.cpp)
    target_link_libraries(${program} PRIVATE hybrid_sphere_ros)
    hybrid_sphere_own(${program})
  endforeach()
endif()

install(TARGETS hybrid_sphere_bag hybrid_sphere_nodelet
  ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION})
install(TARGETS hybrid_sphere_node three_stage_node pursuit record steer_to_target
  RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
# In the source `plot` is not executable: rosrun finds one, that of the devel or the install space.
catkin_install_python(PROGRAMS programs/plot programs/rviz_scene
  DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(FILES programs/plot_figure.py programs/plot_ground.py programs/plot_inputs.py programs/plot_page.py programs/plot_study.py
  programs/plot_study_input.py programs/plot_study_numbers.py programs/scene_view.py
  DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
catkin_install_python(PROGRAMS examples/catch_in_disc.py examples/catch_in_lock_step.py examples/log_switches.py
  DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
install(FILES nodelet_plugins.xml
  DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
install(DIRECTORY config launch rviz
  DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
# What a user copies. Without permissions: rosrun finds the programs among those of the package.
install(DIRECTORY examples
  DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION}
  PATTERN controller_test EXCLUDE)
install(DIRECTORY examples/controller_test
  DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION}/examples
  USE_SOURCE_PERMISSIONS)
