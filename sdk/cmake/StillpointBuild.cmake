# Helpers of the project's own build.
include(StillpointPlugin)

# Warnings for a target. Designated initialisers may leave out fields that have defaults; -Wrestrict
# is wrong about std::string in g++ 12 (GCC bug 105651), and so are three more when headers are
# precompiled. A unity build includes source files, whose unnamed namespaces g++ then takes for a
# header's. The preset `dev` has neither. g++ marks all that is precompiled anew whenever it looks for
# memory that it can free: it takes a tenth less time, and a fifth more memory, when it does so later.
function(stillpoint_compile_options target)
  set(strictness)
  if(STILLPOINT_WARNINGS_AS_ERRORS)
    list(APPEND strictness -Werror)
  endif()
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # clang++, of the sanitizers
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wno-missing-field-initializers ${strictness})
    return()
  endif()
  if(CMAKE_UNITY_BUILD)
    list(APPEND strictness -Wno-subobject-linkage)
  endif()
  if(NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
    list(APPEND strictness -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread)
  endif()
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wno-missing-field-initializers -Wno-restrict -Wshadow -Wnon-virtual-dtor
    -Woverloaded-virtual ${strictness} --param=ggc-min-heapsize=1000000)  # kB
endfunction()

# The headers of OpenCV 4.6 warn under C++20 (arithmetic between enums), hence SYSTEM.
function(stillpoint_link_opencv target scope)
  target_include_directories(${target} SYSTEM ${scope} ${OpenCV_INCLUDE_DIRS})
  target_link_libraries(${target} ${scope} ${ARGN})
endfunction()

# For targets that a sanitizer takes long to compile and that compute little. Headers that are precompiled for
# libraries fit another level of optimisation.
function(stillpoint_sanitize_quickly target)
  if(NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize")
    return()
  endif()
  target_compile_options(${target} PRIVATE -O0)
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "STATIC_LIBRARY")
    set_target_properties(${target} PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)
  endif()
endfunction()

# For targets that compute nothing themselves.
function(stillpoint_compile_quickly target)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  stillpoint_sanitize_quickly(${target})
endfunction()

# Headers that most files include are parsed once: one set for the code of libraries, one for test
# programs, whose flags differ. The preset `dev` builds without, so that no file depends on them.
function(stillpoint_add_precompiled_headers)
  set(empty ${PROJECT_BINARY_DIR}/empty.cpp)
  file(GENERATE OUTPUT ${empty} CONTENT "int main() {}\n")
  set(common <Eigen/Geometry> <memory> <opencv2/core.hpp> <string> <vector> <stillpoint/sdk.hpp>)
  add_library(stillpoint_code_headers OBJECT ${empty})
  target_precompile_headers(stillpoint_code_headers PRIVATE ${common})
  set(owners stillpoint_code_headers)
  if(STILLPOINT_BUILD_TESTS)
    add_executable(stillpoint_test_headers EXCLUDE_FROM_ALL ${empty})
    target_precompile_headers(stillpoint_test_headers PRIVATE ${common} <gmock/gmock.h>)
    target_link_libraries(stillpoint_test_headers PRIVATE GTest::gmock)
    stillpoint_compile_quickly(stillpoint_test_headers)
    list(APPEND owners stillpoint_test_headers)
  endif()
  foreach(owner IN LISTS owners)
    target_include_directories(${owner} PRIVATE ${PROJECT_SOURCE_DIR}/core/include)
    target_link_libraries(${owner} PRIVATE Eigen3::Eigen)
    stillpoint_link_opencv(${owner} PRIVATE opencv_core)
    stillpoint_compile_options(${owner})
  endforeach()
endfunction()

# stillpoint_add_tests(NAME SOURCES… LINK libraries…): one GoogleTest program; its cases become
# tests of ctest.
function(stillpoint_add_tests name)
  if(NOT STILLPOINT_BUILD_TESTS)
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  stillpoint_compile_options(${name})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_compile_definitions(${name} PRIVATE
    STILLPOINT_SOURCE_DIR="${PROJECT_SOURCE_DIR}" STILLPOINT_BINARY_DIR="${PROJECT_BINARY_DIR}")
  target_link_libraries(${name} PRIVATE ${ARG_LINK} stillpoint::sdk GTest::gmock GTest::gtest_main)
  target_precompile_headers(${name} REUSE_FROM stillpoint_test_headers)
  stillpoint_compile_quickly(${name})
  gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST NO_PRETTY_VALUES DISCOVERY_TIMEOUT 60)
endfunction()

# stillpoint_add_library(NAME [TEST name] LINK libraries…): a static library from the sources in the
# current folder but plugin.cpp, included as "FOLDER/…", and a test program from *_test.cpp.
function(stillpoint_add_library name)
  cmake_parse_arguments(ARG "" "TEST" "LINK" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS *.cpp)
  file(GLOB tests CONFIGURE_DEPENDS *_test.cpp)
  list(REMOVE_ITEM sources ${tests} ${CMAKE_CURRENT_SOURCE_DIR}/plugin.cpp)
  add_library(${name} STATIC ${sources})
  target_precompile_headers(${name} REUSE_FROM stillpoint_code_headers)
  stillpoint_compile_options(${name})
  cmake_path(GET CMAKE_CURRENT_SOURCE_DIR PARENT_PATH parent)
  target_include_directories(${name} PUBLIC ${parent})
  target_link_libraries(${name} PUBLIC stillpoint::sdk ${ARG_LINK})
  if(tests)
    if(NOT ARG_TEST)
      set(ARG_TEST ${name}_test)
    endif()
    stillpoint_add_tests(${ARG_TEST} SOURCES ${tests} LINK ${name})
  endif()
endfunction()

# stillpoint_add_project_plugin(NAME LINK libraries…): a plugin of this project from the sources in
# the current folder: a static library with everything but plugin.cpp (for tests), and the plugin
# itself. What is in its folder `models` comes along beside the plugin.
function(stillpoint_add_project_plugin name)
  stillpoint_add_library(${name}_code TEST ${name}_test ${ARGN})

  add_library(stillpoint_${name} MODULE plugin.cpp)
  target_precompile_headers(stillpoint_${name} REUSE_FROM stillpoint_code_headers)
  stillpoint_compile_options(stillpoint_${name})
  target_link_libraries(stillpoint_${name} PRIVATE ${name}_code)
  stillpoint_refuse_missing_symbols(stillpoint_${name})
  target_link_options(stillpoint_${name} PRIVATE -Wl,--exclude-libs,ALL)
  set_target_properties(stillpoint_${name} PROPERTIES
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib/stillpoint/plugins
    INSTALL_RPATH "$ORIGIN/../..")
  install(TARGETS stillpoint_${name} COMPONENT program
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/stillpoint/plugins)
  stillpoint_ship_models(${name})
endfunction()

# Copies the networks of the current folder's `models`, in the build tree as in an installation, and
# compares them with their PROVENANCE.md in a test.
function(stillpoint_ship_models name)
  file(GLOB models CONFIGURE_DEPENDS models/*)
  if(NOT models)
    return()
  endif()
  foreach(model IN LISTS models)
    get_filename_component(file ${model} NAME)
    set(copy ${file})
    if(file MATCHES "^(LICENSE|PROVENANCE)")  # every plugin has its own
      set(copy ${name}_${file})
    endif()
    configure_file(${model} ${PROJECT_BINARY_DIR}/lib/stillpoint/plugins/models/${copy} COPYONLY)
    install(FILES ${model} RENAME ${copy} COMPONENT program
      DESTINATION ${CMAKE_INSTALL_LIBDIR}/stillpoint/plugins/models)
  endforeach()
  if(STILLPOINT_BUILD_TESTS)
    add_test(NAME Models.${name}.AreThoseOfTheirProvenance
      COMMAND ${CMAKE_COMMAND} -DMODELS=${CMAKE_CURRENT_SOURCE_DIR}/models
        -P ${PROJECT_SOURCE_DIR}/sdk/cmake/CheckModels.cmake)
  endif()
endfunction()
