# Checks that every step of one numerics, kind of frame (own rays or resampled) and instruction set takes the same number of
# instructions, whatever the frame shows.
#   cmake -DPROGRAM=<inference_count> -DFOLDER=<scratch> -P check_counts.cmake
cmake_minimum_required(VERSION 3.25)

file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})
execute_process(COMMAND valgrind --tool=callgrind --instr-atstart=no --collect-atstart=no
    --callgrind-out-file=${FOLDER}/counts ${PROGRAM}
  OUTPUT_VARIABLE output ERROR_VARIABLE error RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} under callgrind ended with ${result}:\n${error}")
endif()
string(REGEX MATCHALL "[^\n]+" kinds "${output}")
set(dump 0)
set(report "")
foreach(kind IN LISTS kinds)
  math(EXPR dump "${dump} + 1")
  file(STRINGS ${FOLDER}/counts.${dump} totals REGEX "^totals: ")
  string(REGEX REPLACE "totals: " "" instructions "${totals}")
  if(NOT instructions GREATER 100000)
    message(FATAL_ERROR "dump ${dump} (${kind}) counts '${instructions}' instructions")
  endif()
  if(NOT DEFINED count_${kind})
    set(count_${kind} ${instructions})
    string(APPEND report "\n  ${kind}: ${instructions} instructions")
  elseif(NOT instructions EQUAL count_${kind})
    message(SEND_ERROR "${kind}: ${instructions} instructions in dump ${dump}, ${count_${kind}} before")
  endif()
endforeach()
message(STATUS "equal for every frame:${report}")
