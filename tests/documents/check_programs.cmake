# cmake -DBUILD=<build folder> -P check_programs.cmake
# Installs the programs and runs them with what is installed, not with the source tree.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/run_or_fail.cmake)

set(prefix ${BUILD}/installed_programs)
set(current ${BUILD}/installed_programs_run)
set(data ${prefix}/share/tumblesight)
set(tumblesight ${prefix}/bin/tumblesight)
set(flight ${prefix}/bin/flight)

# Runs a program in the current folder of a user.
function(run_as_user)
  run_or_fail(${CMAKE_COMMAND} -E chdir ${current} ${ARGN})
  set(output "${output}" PARENT_SCOPE)
endfunction()

# What a program that fails says.
function(expect_failure text)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${current} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(FIND "${output}" "${text}" found)
  if(result EQUAL 0 OR found EQUAL -1)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command}: ${result}, not a failure with '${text}':\n${output}")
  endif()
endfunction()

function(expect_text text)
  string(FIND "${output}" "${text}" found)
  if(found EQUAL -1)
    message(FATAL_ERROR "'${text}' is not in:\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${prefix} ${current})
file(MAKE_DIRECTORY ${current})
run_or_fail(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix} --component tumblesight)

# Other data than the source tree has: one target more, and one model less.
file(READ ${data}/missions/2_magellan.toml mission)
string(REPLACE "name = \"magellan\"" "name = \"only_installed\"" mission "${mission}")
file(WRITE ${data}/missions/9_only_installed.toml "${mission}")
file(REMOVE ${data}/models/magellan.tsm)
file(GLOB_RECURSE installed ${prefix}/*)

run_as_user(${tumblesight} --help)
expect_text(simulate)
run_as_user(${tumblesight} simulate --help)
string(REGEX REPLACE "[ \n]+" " " output "${output}")
expect_text("html of the current folder")
expect_failure(only_installed ${tumblesight} simulate --target none)
run_as_user(${tumblesight} evaluate --sensor list)
expect_text(${data}/sensors/flash_256.json)
expect_failure(${data}/models/magellan.tsm ${tumblesight} simulate --target magellan)
expect_failure(share/tumblesight/models/magellan.tsm ${flight} --target magellan --domain 100 --timeout-s 0.1)

run_as_user(${tumblesight} evaluate --target near_shoemaker --sequences 8)
run_as_user(${tumblesight} quantize --to-float32 --model ${data}/models/near_shoemaker.tsm --out near.float32.tsm)
run_as_user(${tumblesight} simulate --sequences 2)
expect_text(${current}/out/near_shoemaker_nominal_seed1)
run_as_user(${tumblesight} simulate --sequences 1 --numerics float32)

file(GLOB_RECURSE left ${prefix}/*)
if(NOT "${left}" STREQUAL "${installed}")
  message(FATAL_ERROR "the programs change the files of their prefix:\n${left}")
endif()
message(STATUS "the installed programs run with what is installed")
