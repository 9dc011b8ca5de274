# stillpoint plugins new KIND: pastes the commands that it prints into a shell, as a user does.
include(${SOURCE_DIR}/tests/install/support.cmake)
set(name my_${KIND})
set(elsewhere "${work}/new plugins/${KIND}")  # with a space
file(REMOVE_RECURSE "${elsewhere}")
file(MAKE_DIRECTORY "${elsewhere}")
set(ENV{CMAKE_GENERATOR} ${GENERATOR})
set(ENV{CXX} ${CXX_COMPILER})
set(ENV{CMAKE_CXX_COMPILER_LAUNCHER} ${CXX_LAUNCHER})

run(${program} plugins new ${KIND} ${name})
string(REGEX REPLACE "^.*build, test and run it:\n" "" commands "${output}")
if(KIND STREQUAL output)
  string(REPLACE "--frames 60" "--frames 8" commands "${commands}")
elseif(NOT KIND STREQUAL source)  # one recording for all others: making it takes longer than all the rest
  string(REGEX REPLACE "\n[^\n]*stillpoint simulate [^\n]* -o ([^\n]*)"
    "\nln -s ${recording_with_people} \\1" commands "${commands}")
  string(REGEX REPLACE "(stillpoint run [^\n]*)" "\\1 --set source.limit=8" commands "${commands}")
endif()
string(REGEX REPLACE "(stillpoint run [^\n]*)" "\\1 --set runtime.validate=full" commands "${commands}")
run(sh -e -c "${commands}")
expect_in_output("100% tests passed")
if(output MATCHES "warning:|No tests were found")
  message(FATAL_ERROR "a warning, or no test:\n${output}")
endif()
if(NOT output MATCHES "${KIND} +${name} [^\n]*/build/libstillpoint_${name}.so")
  message(FATAL_ERROR "${name} is not listed:\n${output}")
endif()
file(READ "${elsewhere}/${name}/out/pipeline.yaml" effective)
file(SIZE "${elsewhere}/${name}/out/trajectory.txt" size)
if(NOT effective MATCHES "type: ${name}" OR size LESS 300)
  message(FATAL_ERROR "${name} was not used, or nothing was tracked:\n${output}")
endif()

if(KIND STREQUAL segmenter)  # this decision uses all that has no label
  run(${program} run ${name}/pipeline.yaml --dataset ${recording_with_people} -o labelled
    --set decision.type=semantic_only)
  file(STRINGS ${elsewhere}/labelled/frames.csv labelled REGEX ",[0-9]*[1-9][0-9]*\\.[0-9]+$")
  list(LENGTH labelled count)
  if(count LESS 20)
    message(FATAL_ERROR "${count} of 40 frames have more than 1 % with labels:\n${labelled}")
  endif()
endif()

if(KIND STREQUAL tracker)
  run(${program} run ${name}/pipeline.yaml --dataset ${recording} -o run)
  expect_small_error("${elsewhere}/run" 0.03)
endif()
