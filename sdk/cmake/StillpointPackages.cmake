# The Debian packages that `cpack` makes in the build folder: what runs, what plugins and programs are
# built with, and the Python module.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME stillpoint)
set(CPACK_PACKAGE_CONTACT "The Stillpoint developers <developers@stillpoint.invalid>")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL program development)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/lib)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)  # and tell the dynamic linker
set(same_version "(= ${PROJECT_VERSION})")

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME stillpoint)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "python3, curl | wget")  # stillpoint-get-models
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "libstillpoint-dev, python3-stillpoint")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
"RGB-D SLAM for scenes in which people and things move
 Estimates the trajectory of a camera that gives colour and depth, and makes a
 dense map with classes, without the people who walk through the picture.
 .
 This package has the program, its plugins and its network for people.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libstillpoint-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "stillpoint ${same_version}, libeigen3-dev (>= 3.4), libopencv-dev (>= 4.6), cmake (>= 3.25), g++")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "libgtest-dev")  # tests of a new plugin
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
"headers for plugins of Stillpoint and for programs that use it
 What 'stillpoint plugins new' needs, the engine for programs of your own, and a
 recording with exact truth for tests.")

if(STILLPOINT_BUILD_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-stillpoint)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "stillpoint ${same_version}, python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3-numpy")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION
"Python module of Stillpoint, RGB-D SLAM for scenes that move
 Runs pipelines on NumPy arrays and evaluates trajectories.")
endif()

foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} name)
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE RENAME copyright COMPONENT ${component}
    DESTINATION share/doc/${CPACK_DEBIAN_${name}_PACKAGE_NAME})
endforeach()
include(CPack)
