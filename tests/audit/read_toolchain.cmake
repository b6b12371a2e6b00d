# Prints what the audit needs from a toolchain file, as lines NAME=VALUE.
#   cmake -DTOOLCHAIN=<file> -P read_toolchain.cmake
set(TUMBLESIGHT_BOARD "")
include(${TOOLCHAIN})
foreach(pair compiler=CMAKE_CXX_COMPILER emulator=CMAKE_CROSSCOMPILING_EMULATOR architecture=CMAKE_SYSTEM_PROCESSOR
    board=TUMBLESIGHT_BOARD)
  string(REPLACE "=" ";" pair ${pair})
  list(GET pair 0 name)
  list(GET pair 1 variable)
  execute_process(COMMAND ${CMAKE_COMMAND} -E echo "${name}=${${variable}}")
endforeach()
