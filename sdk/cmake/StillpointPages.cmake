# Pages for browsers: sources bundled into one HTML file, with modules of the npm registry in the versions of
# tools/report/web/package-lock.json, which all pages share.
option(STILLPOINT_WITH_PAGES "Build the pages of reports and of the live view, with npm and esbuild" ON)

set(STILLPOINT_CAN_BUILD_PAGES OFF)
if(STILLPOINT_WITH_PAGES)
  find_program(NODE node)
  find_program(NPM npm)
  find_program(ESBUILD esbuild)
  if(NODE AND NPM AND ESBUILD)
    set(STILLPOINT_CAN_BUILD_PAGES ON)
  else()
    message(WARNING "Without npm and esbuild, reports and the live view have no page; tools/setup installs them")
  endif()
endif()

set(STILLPOINT_WEB ${PROJECT_SOURCE_DIR}/tools/report/web)
set(STILLPOINT_NODE_MODULES ${PROJECT_BINARY_DIR}/web/node_modules)
if(STILLPOINT_CAN_BUILD_PAGES)
  add_custom_command(OUTPUT ${STILLPOINT_NODE_MODULES}/.package-lock.json
    COMMAND ${CMAKE_COMMAND} -E copy ${STILLPOINT_WEB}/package.json ${STILLPOINT_WEB}/package-lock.json
      ${PROJECT_BINARY_DIR}/web
    COMMAND ${CMAKE_COMMAND} -E chdir ${PROJECT_BINARY_DIR}/web
      ${NPM} ci --ignore-scripts --no-audit --no-fund --prefer-offline --loglevel=error
    DEPENDS ${STILLPOINT_WEB}/package.json ${STILLPOINT_WEB}/package-lock.json
    COMMENT "npm ci: modules of the pages" VERBATIM)
  add_custom_target(stillpoint_node_modules DEPENDS ${STILLPOINT_NODE_MODULES}/.package-lock.json)
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/web)
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
    DEPENDS ${sources} ${STILLPOINT_WEB}/assemble.js stillpoint_node_modules
      ${STILLPOINT_NODE_MODULES}/.package-lock.json
    COMMENT "Page: ${target}" VERBATIM)
  add_custom_target(${target} ALL DEPENDS ${page})
endfunction()
