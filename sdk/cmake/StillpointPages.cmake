# Pages for browsers: sources bundled into one HTML file, with modules of the npm registry in the versions of
# tools/report/web/package-lock.json, which all pages share. STILLPOINT_CAN_BUILD_PAGES says whether that is possible.
option(STILLPOINT_WITH_PAGES "Build the pages of reports and of the live view, with npm and esbuild" ON)

set(STILLPOINT_WEB ${PROJECT_SOURCE_DIR}/tools/report/web)
set(STILLPOINT_NODE_MODULES ${PROJECT_BINARY_DIR}/web/node_modules)

# When configuring, so that a machine without a network builds everything else.
function(stillpoint_fetch_node_modules)
  set(list ${STILLPOINT_WEB}/package-lock.json)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${STILLPOINT_WEB}/package.json ${list})
  if(NOT ${list} IS_NEWER_THAN ${STILLPOINT_NODE_MODULES}/.package-lock.json)
    return()
  endif()
  file(COPY ${STILLPOINT_WEB}/package.json ${list} DESTINATION ${PROJECT_BINARY_DIR}/web)
  execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --prefer-offline --loglevel=error
    WORKING_DIRECTORY ${PROJECT_BINARY_DIR}/web RESULT_VARIABLE result ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(WARNING "Reports and the live view will have no page: their modules cannot be fetched:\n${output}")
    file(REMOVE_RECURSE ${STILLPOINT_NODE_MODULES})
  endif()
endfunction()

set(STILLPOINT_CAN_BUILD_PAGES OFF)
if(STILLPOINT_WITH_PAGES)
  find_program(NODE node)
  find_program(NPM npm)
  find_program(ESBUILD esbuild)
  if(NODE AND NPM AND ESBUILD)
    stillpoint_fetch_node_modules()
    if(EXISTS ${STILLPOINT_NODE_MODULES})
      set(STILLPOINT_CAN_BUILD_PAGES ON)
    endif()
  else()
    message(WARNING "Without npm and esbuild, reports and the live view have no page; tools/setup installs them")
  endif()
endif()

# stillpoint_add_page(TARGET PAGE): from page.html, main.js and what it imports, all in the current folder.
function(stillpoint_add_page target page)
  file(GLOB sources CONFIGURE_DEPENDS *.js *.css page.html)
  set(bundle ${CMAKE_CURRENT_BINARY_DIR}/${target})
  add_custom_command(OUTPUT ${page}
    COMMAND ${CMAKE_COMMAND} -E env NODE_PATH=${STILLPOINT_NODE_MODULES}
      ${ESBUILD} ${CMAKE_CURRENT_SOURCE_DIR}/main.js --bundle --minify --format=iife --target=es2022
      --charset=utf8 --legal-comments=inline --log-level=warning --outfile=${bundle}.js
    COMMAND ${NODE} ${STILLPOINT_WEB}/assemble.js ${CMAKE_CURRENT_SOURCE_DIR}/page.html ${bundle} ${page}
    DEPENDS ${sources} ${STILLPOINT_WEB}/assemble.js ${STILLPOINT_NODE_MODULES}/.package-lock.json
    COMMENT "Page: ${target}" VERBATIM)
  add_custom_target(${target} ALL DEPENDS ${page})
endfunction()
