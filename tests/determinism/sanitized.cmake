# Builds the tests of the algorithms under AddressSanitizer and UndefinedBehaviorSanitizer and runs them.
#   cmake -DSOURCE=<source tree> -DBUILD=<build folder> -P sanitized.cmake
cmake_minimum_required(VERSION 3.25)

set(tests test_gnc_numerics test_gnc_attitude test_gnc_lidar test_gnc_nn test_gnc_surface test_gnc_rcnn test_gnc_estimation)

function(must)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}:\n${output}")
  endif()
endfunction()

# -O1 and few debug symbols: compiles in half the time of the preset's.
must(${CMAKE_COMMAND} -S ${SOURCE} --preset sanitize -B ${BUILD} -DTUMBLESIGHT_SIL=OFF -DTUMBLESIGHT_FEW_TRIALS=ON
  "-DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1 -g1 -DNDEBUG")
must(${CMAKE_COMMAND} --build ${BUILD} --target ${tests})
foreach(test IN LISTS tests)
  must(${BUILD}/bin/${test})
endforeach()
