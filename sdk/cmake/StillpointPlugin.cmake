# For authors of plugins: find_package(Stillpoint REQUIRED COMPONENTS Sdk) brings this function.

# stillpoint_add_plugin(NAME SOURCES…): the target NAME, a library libstillpoint_NAME.so that exports
# its descriptor and nothing else. Installing puts it where the program looks for plugins; from a
# build folder it is found with STILLPOINT_PLUGIN_PATH.
function(stillpoint_add_plugin name)
  include(GNUInstallDirs)
  add_library(${name} MODULE ${ARGN})
  target_link_libraries(${name} PRIVATE stillpoint::sdk)
  # Symbols missing at load time would be found out by the user instead of the author.
  target_link_options(${name} PRIVATE -Wl,--no-undefined)
  set_target_properties(${name} PROPERTIES
    OUTPUT_NAME stillpoint_${name}
    CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON
    CXX_EXTENSIONS OFF
    INSTALL_RPATH "$ORIGIN/../..")
  install(TARGETS ${name} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/stillpoint/plugins)
endfunction()
