# What the tests of the installation share. They get BUILD_DIR, SOURCE_DIR, GENERATOR, CXX_COMPILER and
# CXX_LAUNCHER.
set(work ${BUILD_DIR}/install_test)
set(prefix ${work}/prefix)
set(program ${prefix}/bin/stillpoint)
set(recording ${work}/recording)  # 60 frames of 320 x 240, nobody in them
set(recording_with_people ${work}/recording_with_people)  # 40 frames of 640 x 480
set(elsewhere ${work}/elsewhere)  # has nothing to do with the project
set(compile_quickly ${work}/compile_quickly)  # for CMAKE_CXX_COMPILER_LAUNCHER

# run(COMMAND…): in `elsewhere`; fails the test unless the command succeeds. Its output is left in
# `output`.
function(run)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${elsewhere}
    RESULT_VARIABLE result OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${result}): ${command}\n${out}")
  endif()
  set(output "${out}" PARENT_SCOPE)
endfunction()

function(expect_in_output text)
  string(FIND "${output}" "${text}" position)
  if(position EQUAL -1)
    message(FATAL_ERROR "'${text}' is missing in:\n${output}")
  endif()
endfunction()

# expect_small_error(RUN LIMIT): of the trajectory in the folder RUN on the recording, in metres.
function(expect_small_error run limit)
  run(${program} evaluate --json --reference ${recording}/groundtruth.txt
    --estimate ${run}/trajectory.txt)
  string(JSON error GET "${output}" ate se3_m rmse)
  if(NOT error LESS limit)
    message(FATAL_ERROR "${run} has an error of ${error} m")
  endif()
  message(STATUS "${run}: error ${error} m")
endfunction()
