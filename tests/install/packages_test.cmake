# The Debian packages, unpacked: the program runs alone, names what it needs, and the others complete it.
include(${SOURCE_DIR}/tests/install/support.cmake)
set(root ${work}/packages_root)
file(REMOVE_RECURSE ${root} ${work}/packaged_control)
file(MAKE_DIRECTORY ${root})

function(unpack package)
  file(GLOB file ${BUILD_DIR}/packages/${package}_*.deb)
  run(dpkg-deb -x ${file} ${root})
endfunction()

# expect_depends(PACKAGE NAME…)
function(expect_depends package)
  file(GLOB file ${BUILD_DIR}/packages/${package}_*.deb)
  run(dpkg-deb -f ${file} Depends)
  foreach(name IN LISTS ARGN)
    expect_in_output(${name})
  endforeach()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# expect_brought(PACKAGE FILE…): what CMake looks for in these files comes with the package, as apt installs it.
set(package_of_GTest libgtest-dev)
set(package_of_OpenCV libopencv-dev)
set(package_of_Stillpoint stillpoint)
set(package_of_nlohmann_json nlohmann-json3-dev)
function(expect_brought package)
  file(GLOB file ${BUILD_DIR}/packages/${package}_*.deb)
  run(dpkg-deb -f ${file} Depends Recommends)
  foreach(list IN LISTS ARGN)
    file(STRINGS ${list} lines REGEX "find_package\\(")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^.*find_package\\(([A-Za-z0-9_]+).*$" "\\1" name "${line}")
      if(NOT package_of_${name})
        message(FATAL_ERROR "${list}: which package of Debian has ${name}? Add it above, and to sdk/packages")
      endif()
      expect_in_output(${package_of_${name}})
    endforeach()
  endforeach()
endfunction()

file(REMOVE_RECURSE ${BUILD_DIR}/packages)
execute_process(COMMAND ${CMAKE_CPACK_COMMAND} --config ${BUILD_DIR}/CPackConfig.cmake
  WORKING_DIRECTORY ${BUILD_DIR} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "cpack failed:\n${output}")
endif()

unpack(stillpoint)
set(program ${root}/usr/bin/stillpoint)
run(${program} --version)
run(${program} plugins list --strict)
run(${program} check stillpoint)
run(${program} run orb_baseline --quiet --dataset ${recording} -o ${work}/packaged_run)
expect_small_error(${work}/packaged_run 0.02)
if(EXISTS ${BUILD_DIR}/share/stillpoint/report.html)
  run(${program} report ${work}/packaged_run)

  # The paper's tables, of one sequence cut short.
  file(REMOVE_RECURSE ${work}/packaged_study)
  file(WRITE ${work}/packaged_study.yaml "version: 1
extends: paper_tables
sequences: [{name: walking_xyz, scene: fr3_walking_xyz, frames: 20}]
repeats: 1
pictures: 1
published: []
")
  run(${program} ablate ${work}/packaged_study.yaml -o ${work}/packaged_study)
  expect_in_output("## Improvement of the ATE over orb_baseline")
  run(${program} report ${work}/packaged_study --figures ${work}/packaged_study/figures)
  foreach(file report.html tables.tex results.csv figures/stage_times.pdf figures/walking_xyz/trajectory.svg)
    if(NOT EXISTS ${work}/packaged_study/${file})
      message(FATAL_ERROR "the report of a study has no ${file}:\n${output}")
    endif()
  endforeach()
endif()
run(${root}/usr/bin/stillpoint-get-models --help)
expect_in_output("usage: stillpoint-get-models")
execute_process(COMMAND ${program} plugins new tracker mine WORKING_DIRECTORY ${elsewhere}
  RESULT_VARIABLE result ERROR_VARIABLE output)
if(NOT result EQUAL 2 OR NOT output MATCHES "the package libstillpoint-dev has it")
  message(FATAL_ERROR "without the headers, 'plugins new' says (${result}):\n${output}")
endif()
foreach(file share/man/man1/stillpoint-run.1.gz share/bash-completion/completions/stillpoint
             share/zsh/vendor-completions/_stillpoint share/doc/stillpoint/copyright share/doc/stillpoint/changelog.gz bin/stillpoint-demo
             share/man/man1/stillpoint-demo.1.gz share/man/man1/stillpoint-get-models.1.gz)
  if(NOT EXISTS ${root}/usr/${file})
    message(FATAL_ERROR "the package stillpoint has no /usr/${file}")
  endif()
endforeach()
file(GLOB package ${BUILD_DIR}/packages/stillpoint_*.deb)
run(dpkg-deb -e ${package} ${work}/packaged_control)
file(READ ${work}/packaged_control/triggers triggers)
file(STRINGS ${work}/packaged_control/shlibs shlibs REGEX "^libstillpoint_(engine|sdk|testing) ")
file(GLOB libraries ${root}/usr/lib/libstillpoint_*.so.[0-9]*.[0-9]*.[0-9]*)  # the files, not the links
list(LENGTH shlibs count)
list(LENGTH libraries library_count)
if(NOT count EQUAL 3 OR NOT library_count EQUAL 3)
  message(FATAL_ERROR "the package says it has the shared libraries ${shlibs}, and has ${libraries}")
endif()
foreach(line IN LISTS shlibs)
  string(REGEX REPLACE "^([^ ]+) ([^ ]+) .*" "\\1.so.\\2" library "${line}")
  if(NOT EXISTS ${root}/usr/lib/${library})
    message(FATAL_ERROR "shlibs of the package names ${library}, which it does not have")
  endif()
endforeach()
if(NOT triggers MATCHES "activate-noawait ldconfig")
  message(FATAL_ERROR "the package does not have ldconfig triggered: ${triggers}")
endif()
expect_depends(stillpoint libopencv-dnn406 libopencv-imgcodecs406 libyaml-cpp0.7 libsqlite3-0 libcairo2)
if(output MATCHES "libfreenect|libopenni2|libddsc")
  message(FATAL_ERROR "the package stillpoint depends on libraries that are loaded late:\n${output}")
endif()

unpack(libstillpoint-dev)
expect_depends(libstillpoint-dev stillpoint libeigen3-dev libopencv-dev)
file(GLOB lists ${SOURCE_DIR}/sdk/examples/*/CMakeLists.txt ${SOURCE_DIR}/sdk/templates/common/CMakeLists.txt)
expect_brought(libstillpoint-dev ${lists})
file(REMOVE_RECURSE ${work}/packaged)
run(${program} plugins new output packaged -o ${work}/packaged)
run(${CMAKE_COMMAND} -S ${work}/packaged -B ${work}/packaged/build -G ${GENERATOR}
  -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_PREFIX_PATH=${root}/usr
  -D CMAKE_CXX_COMPILER_LAUNCHER=${CXX_LAUNCHER} -D CMAKE_DISABLE_FIND_PACKAGE_GTest=ON)
expect_in_output("packaged_test is not built")  # without GoogleTest, the plugin alone
run(${CMAKE_COMMAND} --build ${work}/packaged/build)
run(${CMAKE_CTEST_COMMAND} --test-dir ${work}/packaged/build)
expect_in_output("100% tests passed, 0 tests failed out of 1")
run(${program} run ${work}/packaged/pipeline.yaml --quiet --dataset ${recording} --set source.limit=3
  -o ${work}/packaged/out)

# The example that pushes its own images, as its README builds it.
run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/sdk/examples/push_frames -B ${work}/packaged_push -G ${GENERATOR}
  -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_PREFIX_PATH=${root}/usr
  -D CMAKE_CXX_COMPILER_LAUNCHER=${CXX_LAUNCHER})
run(${CMAKE_COMMAND} --build ${work}/packaged_push)
run(${work}/packaged_push/push_frames)
if(NOT output MATCHES "after 1.97 s at 0.29[0-9] -?0.00[0-4] -?0.00[0-4] m")
  message(FATAL_ERROR "the camera went 0.295 m to the right, but:\n${output}")
endif()

# The tracker of another kind, as its README builds it.
run(${CMAKE_COMMAND} -S ${SOURCE_DIR}/sdk/examples/icp_tracker -B ${work}/packaged_icp -G ${GENERATOR}
  -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_PREFIX_PATH=${root}/usr
  -D CMAKE_CXX_COMPILER_LAUNCHER=${CXX_LAUNCHER} -D CMAKE_DISABLE_FIND_PACKAGE_GTest=ON)
run(${CMAKE_COMMAND} --build ${work}/packaged_icp)
run(${CMAKE_CTEST_COMMAND} --test-dir ${work}/packaged_icp)

unpack(stillpoint-doc)
find_program(python python3 REQUIRED)
run(${python} -B ${SOURCE_DIR}/tests/docs/check_links.py ${root}/usr/share/doc/stillpoint-doc)

if(PYTHON)
  unpack(python3-stillpoint)
  expect_depends(python3-stillpoint stillpoint python3-numpy)
  run(${CMAKE_COMMAND} -E env PYTHONPATH=${root}/usr/lib/python3/dist-packages
    ${PYTHON} ${SOURCE_DIR}/sdk/examples/push_arrays/push_arrays.py)
  expect_in_output("90 of 90 frames tracked, error 0.")  # mm
endif()

# The demo, with a recording that is there already: making the whole one takes minutes.
function(check_demo)
  set(demo ${work}/packaged_demo)
  set(recording ${demo}/recording)
  file(REMOVE_RECURSE ${demo})
  file(COPY ${recording_with_people}/ DESTINATION ${recording})
  file(TOUCH ${recording}/complete)
  run(${root}/usr/bin/stillpoint-demo ${demo})
  set(error "0\\.[0-9][0-9][0-9] m")
  if(NOT output MATCHES "off by ${error} without Stillpoint, ${error} with it")
    message(FATAL_ERROR "the demo ends without its two errors:\n${output}")
  endif()
  expect_small_error(${demo}/with 0.02)
  foreach(picture without/trajectory.png without/map.png with/trajectory.png with/map.png)
    file(SIZE ${demo}/${picture} size)
    if(size LESS 5000)
      message(FATAL_ERROR "${picture} of the demo has ${size} bytes only")
    endif()
  endforeach()
endfunction()
check_demo()

# OpenCV's codecs are loaded when the first image needs them.
set(with_pictures --quiet --dataset ${recording} -o ${work}/packaged_run --set source.limit=3
  --set "outputs=[{type: trajectory}, {type: images, every: 1}]")
run(${program} run orb_baseline ${with_pictures})
file(REMOVE ${root}/usr/lib/stillpoint/libstillpoint_image_codec.so)
run(${program} run orb_baseline --quiet --dataset ${recording} -o ${work}/packaged_run --set source.limit=3)
execute_process(COMMAND ${program} run orb_baseline ${with_pictures}
  RESULT_VARIABLE result ERROR_VARIABLE output)
if(NOT result EQUAL 1 OR NOT output MATCHES "libstillpoint_image_codec.so: cannot be loaded: [^\n]*install it again")
  message(FATAL_ERROR "without its codecs, the program says (${result}):\n${output}")
endif()
