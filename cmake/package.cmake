# The Debian package by cpack, as scripts/package calls it.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME hybrid-sphere)
set(CPACK_PACKAGE_CONTACT ${${PROJECT_NAME}_MAINTAINER})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "simulator of a sphere on ground that is smooth and rough (ROS)
Event-driven simulation of Mei's hybrid nonholonomic system: a sphere slides
over smooth ground and rolls over rough ground, and every switch of the
constraint is a message with its impulse, stamped with its own instant.
A ROS node, a nodelet, an offline runner, and what it takes to build on them.")

# The libraries by what the programs link to, all else by the groups of scripts/install_dependencies.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
foreach(relation DEPENDS:run RECOMMENDS:view SUGGESTS:build)
  string(REPLACE ":" ";" relation ${relation})
  list(GET relation 0 field)
  list(GET relation 1 group)
  execute_process(COMMAND ${PROJECT_SOURCE_DIR}/scripts/install_dependencies --list ${group}
    OUTPUT_VARIABLE packages OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE "\n" ", " CPACK_DEBIAN_PACKAGE_${field} "${packages}")
endforeach()

if(TARGET study)
  string(APPEND CPACK_DEBIAN_PACKAGE_RECOMMENDS ", openmpi-bin")
endif()
# Which no list of packages to install can say: of any architecture.
string(PREPEND CPACK_DEBIAN_PACKAGE_DEPENDS "python3:any, ")

# What Debian expects of any package, and what it does with Python modules.
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/package_files.cmake)
set(CPACK_HYBRID_SPHERE_SOURCE ${PROJECT_SOURCE_DIR})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
foreach(script postinst:py3compile prerm:py3clean)
  string(REPLACE ":" ";" script ${script})
  list(GET script 0 name)
  list(GET script 1 command)
  set(file ${PROJECT_BINARY_DIR}/package/${name})
  file(WRITE ${file} "#!/bin/sh\nset -e\nif command -v ${command} >/dev/null; then\n  ${command} -p ${CPACK_PACKAGE_NAME}\nfi\n")
  list(APPEND CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${file})
endforeach()
file(WRITE ${PROJECT_BINARY_DIR}/package/triggers "activate-noawait ldconfig\n")
list(APPEND CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/package/triggers)
include(CPack)
