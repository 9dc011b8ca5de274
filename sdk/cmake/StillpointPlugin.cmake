# For authors of plugins: find_package(Stillpoint REQUIRED COMPONENTS Sdk) brings stillpoint_add_plugin().

# Symbols missing at load time would be found out by the user instead of the author. The run-time library of
# clang++'s sanitizers is in the program.
function(stillpoint_refuse_missing_symbols target)
  if(NOT (CMAKE_CXX_COMPILER_ID MATCHES "Clang" AND CMAKE_CXX_FLAGS MATCHES "-fsanitize"))
    target_link_options(${target} PRIVATE -Wl,--no-undefined)
  endif()
endfunction()

# stillpoint_add_plugin(NAME SOURCES… [CHECK_OPTIONS …]): the target NAME, a library
# libstillpoint_NAME.so that exports its descriptor and nothing else. Installing puts it where the
# program looks for plugins; from a build folder it is found with STILLPOINT_PLUGIN_PATH. Where tests
# are enabled, NAME.KeepsItsContracts runs `stillpoint plugins check` on it, with CHECK_OPTIONS after
# the library, such as --set path=DIR.
function(stillpoint_add_plugin name)
  include(GNUInstallDirs)
  cmake_parse_arguments(ARG "" "" "CHECK_OPTIONS" ${ARGN})
  add_library(${name} MODULE ${ARG_UNPARSED_ARGUMENTS})
  add_test(NAME ${name}.KeepsItsContracts
    COMMAND stillpoint::stillpoint plugins check $<TARGET_FILE:${name}> ${ARG_CHECK_OPTIONS})
  target_link_libraries(${name} PRIVATE stillpoint::sdk)
  stillpoint_refuse_missing_symbols(${name})
  set_target_properties(${name} PROPERTIES
    OUTPUT_NAME stillpoint_${name}
    CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON
    CXX_EXTENSIONS OFF
    INSTALL_RPATH "$ORIGIN/../..")
  install(TARGETS ${name} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/stillpoint/plugins)
endfunction()
