# catkin fixes the environment of the tests when it is found, and leaves out folders that are not there yet.
if(DEFINED CATKIN_DEVEL_PREFIX)
  file(MAKE_DIRECTORY ${CATKIN_DEVEL_PREFIX}/lib/pkgconfig ${CATKIN_DEVEL_PREFIX}/lib/python3/dist-packages)
endif()

# pluginlib's configuration looks for a Python of its own: one for all.
if(PYTHON_EXECUTABLE AND NOT Python3_EXECUTABLE)
  set(Python3_EXECUTABLE ${PYTHON_EXECUTABLE})
endif()

# Messages and services, and what other packages see of this one.
find_package(catkin REQUIRED COMPONENTS
  diagnostic_updater
  dynamic_reconfigure
  geometry_msgs
  interactive_markers
  message_generation
  nav_msgs
  nodelet
  pluginlib
  roscpp
  rosgraph_msgs
  roslib
  sensor_msgs
  std_msgs
  std_srvs
  tf2_msgs
  tf2_ros
  visualization_msgs)

find_package(rosbag_storage REQUIRED)
find_package(topic_tools REQUIRED)

add_message_files(DIRECTORY msg FILES
  ConstraintSwitch.msg
  SceneView.msg
  SimulatorStatus.msg
  SphereState.msg
  SurfaceMap.msg
  SurfaceRegion.msg
  SystemState.msg
  SystemSwitch.msg)
add_service_files(DIRECTORY srv FILES
  GetState.srv
  GetSurfaceMap.srv
  Kick.srv
  SetInitialState.srv
  SetSurfaceMap.srv
  Step.srv)
generate_messages(DEPENDENCIES geometry_msgs std_msgs)

generate_dynamic_reconfigure_options(cfg/Simulator.cfg)

catkin_package(
  INCLUDE_DIRS include
  LIBRARIES hybrid_sphere_core hybrid_sphere_mechanics
  CATKIN_DEPENDS geometry_msgs interactive_markers message_runtime nav_msgs roscpp rosgraph_msgs sensor_msgs std_msgs std_srvs
    tf2_msgs visualization_msgs
  DEPENDS EIGEN3
  CFG_EXTRAS hybrid_sphere-extras.cmake)

# Programs of an install space find its libraries where nothing has been sourced; those of /usr find theirs anyway.
if(NOT CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(CMAKE_INSTALL_RPATH "$ORIGIN:$ORIGIN/..")
endif()
