# Builds the node against the installation and runs its own tests.
include(${SOURCE_DIR}/tests/install/support.cmake)
execute_process(COMMAND pkg-config --exists roscpp tf2_ros message_filters RESULT_VARIABLE missing)
if(missing OR NOT EXISTS /usr/lib/gencpp/gen_cpp.py)
  message(STATUS "skipped: ROS 1 is not installed; tools/setup --tests installs its packages")
  return()
endif()
set(ENV{CXXFLAGS} "-Wall -Wextra -Wshadow -Wno-missing-field-initializers -Werror")
# As it compiles fastest: all of ROS's headers once, nothing optimised.
run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/sdk/ros1 -B ${work}/ros1 -G ${GENERATOR}
  -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_CXX_COMPILER_LAUNCHER=${CXX_LAUNCHER}
  -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_BUILD_TYPE=None -D CMAKE_UNITY_BUILD=ON
  -D CMAKE_UNITY_BUILD_BATCH_SIZE=0)
run(${CMAKE_COMMAND} --build ${work}/ros1)
run(${CMAKE_CTEST_COMMAND} --test-dir ${work}/ros1 --output-on-failure)
expect_in_output("100% tests passed")
run(${CMAKE_COMMAND} --install ${work}/ros1 --prefix ${work}/ros1_prefix)
