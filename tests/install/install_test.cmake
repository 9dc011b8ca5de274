# Builds a plugin of one file against the installation, and calls the installed program with it from a
# folder that has nothing to do with the project.
include(${SOURCE_DIR}/tests/install/support.cmake)

run(${program} --version)
expect_in_output("stillpoint ")
run(${program} evaluate
  --reference ${SOURCE_DIR}/tests/evaluation/data/square_reference.txt
  --estimate ${SOURCE_DIR}/tests/evaluation/data/square_estimate.txt)
expect_in_output("ATE, SE(3)")
run(${program} plugins list)
expect_in_output("tum_rgbd")

run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/tests/install/external_plugin -B ${work}/plugin
  -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_CXX_COMPILER_LAUNCHER=${compile_quickly}
  -D CMAKE_BUILD_TYPE=Release
  -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_INSTALL_PREFIX=${prefix})
run(${CMAKE_COMMAND} --build ${work}/plugin)
run(${CMAKE_COMMAND} -E env STILLPOINT_PLUGIN_PATH=${work}/plugin ${program} plugins list)
expect_in_output("depth_change")
run(${CMAKE_COMMAND} --install ${work}/plugin)
run(${program} plugins list)
expect_in_output("depth_change")
