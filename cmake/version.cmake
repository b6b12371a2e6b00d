# project_version: the header cmake/version.hpp with the project's version and commit, for the programs' --version.
# Only files that include it are compiled again after a commit. This needs no new configuration: git appends to
# logs/HEAD with every commit and checkout.
if(CMAKE_SCRIPT_MODE_FILE)
  # cmake -DSOURCE=<folder> -DPROJECT_VERSION=<version> -DOUT=<file> -P version.cmake
  execute_process(COMMAND git describe --always --abbrev=12 WORKING_DIRECTORY ${SOURCE}
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    set(commit unknown)
  endif()
  configure_file(${CMAKE_CURRENT_LIST_DIR}/version.hpp.in ${OUT} @ONLY)
  file(TOUCH ${OUT})
  return()
endif()

set(head_log "")
execute_process(COMMAND git rev-parse --git-path logs/HEAD WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
  OUTPUT_VARIABLE head_log OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
cmake_path(ABSOLUTE_PATH head_log BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
if(NOT IS_DIRECTORY ${head_log} AND EXISTS ${head_log})
  set(version_depends ${head_log})
endif()
add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/cmake/version.hpp
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DPROJECT_VERSION=${PROJECT_VERSION}
    -DOUT=${PROJECT_BINARY_DIR}/cmake/version.hpp -P ${CMAKE_CURRENT_LIST_FILE}
  DEPENDS ${CMAKE_CURRENT_LIST_DIR}/version.hpp.in ${CMAKE_CURRENT_LIST_FILE} ${version_depends}
  COMMENT "Version and commit" VERBATIM)
add_custom_target(project_version_header DEPENDS ${PROJECT_BINARY_DIR}/cmake/version.hpp)
add_library(project_version INTERFACE)
add_dependencies(project_version project_version_header)
target_include_directories(project_version INTERFACE ${PROJECT_BINARY_DIR})
