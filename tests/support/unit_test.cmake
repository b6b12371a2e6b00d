# GoogleTest and Eigen's geometry take longer to read than most tests take to compile: they are compiled once for all tests.
file(CONFIGURE OUTPUT precompiled.cpp CONTENT "// Only its precompiled headers are used.\n")
add_library(test_precompiled OBJECT ${CMAKE_CURRENT_BINARY_DIR}/precompiled.cpp)
target_link_libraries(test_precompiled PRIVATE project_rules GTest::gtest)
# The tests' own code is optimized less than what they test: it compiles in two thirds of the time.
option(TUMBLESIGHT_FEW_TRIALS "Fewer trials with random numbers in the tests: tests/support/trials.hpp" ${CMAKE_CROSSCOMPILING})
add_library(test_rules INTERFACE)
target_compile_options(test_rules INTERFACE $<$<CONFIG:Release>:-O1> $<$<CONFIG:RelWithDebInfo>:-O0>)
target_compile_definitions(test_rules INTERFACE TUMBLESIGHT_FEW_TRIALS=$<BOOL:${TUMBLESIGHT_FEW_TRIALS}>)
target_link_libraries(test_precompiled PRIVATE test_rules)
target_precompile_headers(test_precompiled PRIVATE <gtest/gtest.h> <Eigen/Geometry>)
# ccache takes a precompiled header's includes from the output of the preprocessor.
target_compile_options(test_precompiled PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)

# One program of unit tests, and a ctest test for each of its tests. In an emulator, where a process takes long to start, a
# ctest test is the whole program or one of its PARTS, so that two of them share the work.
#   add_unit_test(<program> SOURCES <file>... LIBRARIES <target>... [TIMEOUT <seconds>] [COST <n>] [PARTS <n>]
#     [PRECOMPILED <target>])
# COST: ctest starts tests of a higher cost first. PRECOMPILED: the target whose precompiled headers it takes.
function(add_unit_test program)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "TIMEOUT;COST;PARTS;PRECOMPILED" "SOURCES;LIBRARIES")
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT ${test_timeout_s})
  endif()
  if(NOT arg_COST)
    set(arg_COST 0)
  endif()
  if(NOT arg_PRECOMPILED)
    set(arg_PRECOMPILED test_precompiled)
  endif()
  add_executable(${program} ${arg_SOURCES})
  target_link_libraries(${program} PRIVATE ${arg_LIBRARIES} project_rules GTest::gtest_main)
  if(arg_PRECOMPILED STREQUAL test_precompiled)  # the flags of the precompiled headers
    target_link_libraries(${program} PRIVATE test_rules)
  else()  # GCC accepts precompiled headers of another optimization level, but not of none
    target_compile_options(${program} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  target_precompile_headers(${program} REUSE_FROM ${arg_PRECOMPILED})
  target_compile_options(${program} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  if(NOT CMAKE_CROSSCOMPILING)
    gtest_discover_tests(${program} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT ${arg_TIMEOUT} COST ${arg_COST})
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
    set_tests_properties(${test} PROPERTIES TIMEOUT ${arg_TIMEOUT} COST ${arg_PARTS}
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
