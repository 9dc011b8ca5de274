# The Debian packages, unpacked: the program runs alone, names what it needs, and the others complete it.
include(${SOURCE_DIR}/tests/install/support.cmake)
set(root ${work}/packages_root)
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
expect_depends(stillpoint libopencv-dnn406 libyaml-cpp0.7 libsqlite3-0 libcairo2)
if(output MATCHES "libfreenect|libopenni2|libddsc")
  message(FATAL_ERROR "the package stillpoint depends on libraries that are loaded late:\n${output}")
endif()

unpack(libstillpoint-dev)
expect_depends(libstillpoint-dev stillpoint libeigen3-dev libopencv-dev)
run(${program} plugins new output packaged -o ${work}/packaged)
run(${CMAKE_COMMAND} -S ${work}/packaged -B ${work}/packaged/build -G ${GENERATOR}
  -D CMAKE_CXX_COMPILER=${CXX_COMPILER} -D CMAKE_PREFIX_PATH=${root}/usr)

if(PYTHON)
  unpack(python3-stillpoint)
  expect_depends(python3-stillpoint stillpoint python3-numpy)
  run(${CMAKE_COMMAND} -E env PYTHONPATH=${root}/usr/lib/python3/dist-packages
    ${PYTHON} -c "import stillpoint; print(stillpoint.Engine)")
endif()
