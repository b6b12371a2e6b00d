# Builds the digest program with another compiler or other flags and compares its digests with the golden ones: 20 frames with
# every instruction set, 1,000 frames with the fastest set in fixed point.
#   cmake -DSOURCE=<source tree> -DBUILD=<build folder> -DCOMPILER=<c++> -DFLAGS=<flags> -DGOLDEN=<file> -P variant.cmake
cmake_minimum_required(VERSION 3.25)

function(must)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}:\n${output}")
  endif()
endfunction()

must(${CMAKE_COMMAND} -S ${SOURCE} -B ${BUILD} -G Ninja -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=None
  "-DCMAKE_CXX_FLAGS=${FLAGS}" -DTUMBLESIGHT_SIL=OFF -DTUMBLESIGHT_TESTS=ON)
must(${CMAKE_COMMAND} --build ${BUILD} --target digest)

set(DIGEST ${BUILD}/bin/digest)
set(FRAMES 20)
include(${CMAKE_CURRENT_LIST_DIR}/check_digest.cmake)
list(FILTER LINES INCLUDE REGEX "^fixed ")
list(GET LINES -1 fastest)
string(REGEX REPLACE "^fixed ([^ ]+) .*" "\\1" SET "${fastest}")
set(FRAMES 1000)
include(${CMAKE_CURRENT_LIST_DIR}/check_digest.cmake)
