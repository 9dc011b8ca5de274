# Builds a plugin of one file and a program with the engine against the installation, and calls them and
# the installed program from a folder that has nothing to do with the project.
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
  -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_BUILD_TYPE=Release
  -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_INSTALL_PREFIX=${prefix})
run(${CMAKE_COMMAND} --build ${work}/plugin)
run(${CMAKE_COMMAND} -E env STILLPOINT_PLUGIN_PATH=${work}/plugin ${program} plugins list)
expect_in_output("depth_change")
run(${CMAKE_COMMAND} --install ${work}/plugin)
run(${program} plugins list)
expect_in_output("depth_change")

run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/sdk/examples/push_frames -B ${work}/push_frames
  -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_BUILD_TYPE=Release
  -D CMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${work}/push_frames)
run(${work}/push_frames/push_frames)
# 59 steps of 5 mm along the wall.
if(NOT output MATCHES "after 1.97 s at 0.29[0-9] -?0.00[0-4] -?0.00[0-4] m")
  message(FATAL_ERROR "the camera went 0.295 m to the right, but:\n${output}")
endif()

# A tracker of another kind than the project's: no features, no landmarks.
run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/sdk/examples/icp_tracker -B ${work}/icp_tracker
  -G ${GENERATOR} -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_BUILD_TYPE=Release
  -D CMAKE_PREFIX_PATH=${prefix})
run(${CMAKE_COMMAND} --build ${work}/icp_tracker)
run(${CMAKE_COMMAND} -E env STILLPOINT_PLUGIN_PATH=${work}/icp_tracker
  ${program} run ${SOURCE_DIR}/sdk/examples/icp_tracker/icp_odometry.yaml
  --dataset ${recording} -o ${work}/run)
expect_small_error(${work}/run 0.02)
if(NOT EXISTS ${work}/run/map/map.ot)
  message(FATAL_ERROR "ICP's key frames gave no dense map")
endif()

if(PYTHON)
  run(${CMAKE_COMMAND} -E env PYTHONPATH=${prefix}/lib/python3/dist-packages
    ${PYTHON} ${SOURCE_DIR}/sdk/examples/push_arrays/push_arrays.py)
  expect_in_output("90 of 90 frames tracked, error 0.")  # mm
  expect_in_output("weights: plate 0, wall 255")
  expect_in_output(" 0 of them at the plate")
endif()
