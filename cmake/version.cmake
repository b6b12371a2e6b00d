# project_version: the header cmake/version.hpp with the project's version and commit, for the programs' --version.
# Every build asks git, since any change of a file makes the tree another one than the commit. The header is written
# only if its text differs, and only files that include it are compiled again.
if(CMAKE_SCRIPT_MODE_FILE)
  # cmake -DSOURCE=<folder> -DPROJECT_VERSION=<version> -DOUT=<file> -P version.cmake
  execute_process(COMMAND git --no-optional-locks describe --always --abbrev=12 --dirty WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    set(commit unknown)
  endif()
  configure_file(${CMAKE_CURRENT_LIST_DIR}/version.hpp.in ${OUT} @ONLY)
  return()
endif()

add_custom_target(project_version_header
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DPROJECT_VERSION=${PROJECT_VERSION}
    -DOUT=${PROJECT_BINARY_DIR}/cmake/version.hpp -P ${CMAKE_CURRENT_LIST_FILE}
  BYPRODUCTS ${PROJECT_BINARY_DIR}/cmake/version.hpp
  COMMENT "Version and commit" VERBATIM)
add_library(project_version INTERFACE)
add_dependencies(project_version project_version_header)
target_include_directories(project_version INTERFACE ${PROJECT_BINARY_DIR})
