# The tests' own code is optimized less than what they test: it compiles in two thirds of the time.
option(TUMBLESIGHT_FEW_TRIALS "Fewer trials with random numbers in the tests: tests/support/trials.hpp" ${CMAKE_CROSSCOMPILING})
add_library(test_rules INTERFACE)
target_compile_options(test_rules INTERFACE $<$<CONFIG:Release>:-O1> $<$<CONFIG:RelWithDebInfo>:-O0>)
target_compile_definitions(test_rules INTERFACE TUMBLESIGHT_FEW_TRIALS=$<BOOL:${TUMBLESIGHT_FEW_TRIALS}>)
add_precompiled_headers(test_headers RULES test_rules GTest::gtest
  HEADERS <gtest/gtest.h> <Eigen/Geometry> <algorithm> <filesystem> <fstream> <random>)

# One program of unit tests, and a ctest test for each of its tests. In an emulator, where a process takes long to start, a
# ctest test is the whole program or one of its PARTS, so that two of them share the work.
#   add_unit_test(<program> SOURCES <file>... LIBRARIES <target>... [TIMEOUT <seconds>] [COST <n>] [PARTS <n>]
#     [PRECOMPILED <target>] [SEPARATE_SOURCES])
# COST: ctest starts tests of a higher cost first. PRECOMPILED: the target whose precompiled headers it takes. SEPARATE_SOURCES:
# its sources use one name for different things, so that they are not compiled in groups. The label of its tests is the folder
# that they test: gnc/nn.
function(add_unit_test program)
  cmake_parse_arguments(PARSE_ARGV 1 arg "SEPARATE_SOURCES" "TIMEOUT;COST;PARTS;PRECOMPILED" "SOURCES;LIBRARIES")
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT ${test_timeout_s})
  endif()
  if(NOT arg_COST)
    set(arg_COST 0)
  endif()
  if(NOT arg_PRECOMPILED)
    set(arg_PRECOMPILED test_headers)
  endif()
  add_executable(${program} ${arg_SOURCES})
  target_link_libraries(${program} PRIVATE ${arg_LIBRARIES} project_rules GTest::gtest_main)
  if(arg_PRECOMPILED STREQUAL test_headers)  # the flags of the precompiled headers
    target_link_libraries(${program} PRIVATE test_rules)
  else()  # GCC accepts precompiled headers of another optimization level, but not of none
    target_compile_options(${program} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  use_precompiled_headers(${arg_PRECOMPILED} ${program})
  if(arg_SEPARATE_SOURCES)
    set_target_properties(${program} PROPERTIES UNITY_BUILD OFF)
  endif()
  tested_folder(label ${arg_SOURCES})
  note_test_program(${program} ${label})
  if(NOT CMAKE_CROSSCOMPILING)
    gtest_discover_tests(${program} DISCOVERY_TIMEOUT 60
      PROPERTIES TIMEOUT ${arg_TIMEOUT} COST ${arg_COST} LABELS ${label})
    return()
  endif()
  if(NOT arg_PARTS)
    set(arg_PARTS 1)
  endif()
  foreach(part RANGE 1 ${arg_PARTS})
    set(test ${program})
    if(arg_PARTS GREATER 1)
      string(APPEND test "_${part}_of_${arg_PARTS}")
    endif()
    math(EXPR index "${part} - 1")
    add_test(NAME ${test} COMMAND ${program} --gtest_brief=1)
    set_tests_properties(${test} PROPERTIES TIMEOUT ${arg_TIMEOUT} COST ${arg_PARTS} LABELS ${label}
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${arg_PARTS};GTEST_SHARD_INDEX=${index}")
  endforeach()
endfunction()

# Sets properties of tests that ctest discovers: set_unit_test_properties(<test>... PROPERTIES <name> <value>...)
function(set_unit_test_properties)
  if(CMAKE_CROSSCOMPILING)
    return()  # its tests are those of whole programs
  endif()
  list(JOIN ARGN " " arguments)
  string(MD5 id "${arguments}")
  set(script ${CMAKE_CURRENT_BINARY_DIR}/test_properties_${id}.cmake)
  file(WRITE ${script} "set_tests_properties(${arguments})\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${script})
endfunction()
