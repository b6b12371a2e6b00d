# Runs the digest program and compares every line of it with the golden values.
#   cmake -DDIGEST=<program> -DFRAMES=<number> -DGOLDEN=<file> [-DSET=<instruction set>] -P check_digest.cmake
# Sets LINES to the lines that the program printed.
cmake_minimum_required(VERSION 3.25)

execute_process(COMMAND ${DIGEST} ${FRAMES} ${SET} OUTPUT_VARIABLE output RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${DIGEST} ended with ${result}")
endif()
string(REGEX MATCHALL "[^\n]+" LINES "${output}")
file(STRINGS ${GOLDEN} golden)
set(numerics_seen "")
foreach(line IN LISTS LINES)
  string(REGEX MATCH "^([^ ]+) ([^ ]+) ([0-9]+) ([0-9a-f]+)$" matched "${line}")
  if(NOT matched OR NOT "${CMAKE_MATCH_1} ${CMAKE_MATCH_3} ${CMAKE_MATCH_4}" IN_LIST golden)
    message(FATAL_ERROR "digest differs from ${GOLDEN}: ${line}")
  endif()
  list(APPEND numerics_seen ${CMAKE_MATCH_1})
endforeach()
if(NOT "fixed" IN_LIST numerics_seen)
  message(FATAL_ERROR "the output has no fixed-point digest:\n${output}")
endif()
message(STATUS "all digests are golden:\n${output}")
