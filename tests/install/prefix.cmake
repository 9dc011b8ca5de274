# Installs into an empty prefix and makes recordings with the installed program, for the tests beside
# this one, and the launcher of the compiler that they build projects with.
include(${SOURCE_DIR}/tests/install/support.cmake)
file(REMOVE_RECURSE ${work})
file(MAKE_DIRECTORY ${elsewhere})
configure_file(${SOURCE_DIR}/tests/install/compile_quickly.in ${compile_quickly} @ONLY)
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})
run(${program} simulate fr3_walking_xyz_empty --frames 60 -o ${recording}
  --set camera.width=320 --set camera.height=240 --set camera.fx=267.7 --set camera.fy=269.6
  --set camera.cx=159.8 --set camera.cy=123.6)
run(${program} simulate fr3_walking_xyz --frames 40 -o ${recording_with_people})
