# Labels of tests: the folder that they test (gnc/nn), or that of the tests themselves (tests/sil). `ctest -L gnc` runs those of a
# folder, and `tests/run gnc/nn` builds no more than these.

# The folder of the tree that tests test: the one that all of the sources NAME_test.cpp have in common.
function(tested_folder result)
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  string(REGEX REPLACE "^tests/unit/" "" folder ${folder})
  list(FILTER ARGN INCLUDE REGEX "_test\\.cpp$")
  list(GET ARGN 0 common)
  foreach(source ${ARGN})
    while(common AND NOT source MATCHES "^${common}/")
      cmake_path(GET common PARENT_PATH common)
    endwhile()
  endforeach()
  if(common)
    cmake_path(APPEND folder ${common})
  endif()
  set(${result} ${folder} PARENT_SCOPE)
endfunction()

# A line "folder program" of test_programs.txt in the build folder: what tests/run FOLDER builds.
file(WRITE ${PROJECT_BINARY_DIR}/test_programs.txt "")
function(note_test_program program folder)
  if(NOT IS_DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} AND NOT IS_DIRECTORY ${PROJECT_SOURCE_DIR}/tests/unit/${folder})
    message(FATAL_ERROR "${program} tests '${folder}', which is no folder: its sources have none in common")
  endif()
  file(APPEND ${PROJECT_BINARY_DIR}/test_programs.txt "${folder} ${program}\n")
endfunction()

# Gives the tests that add_test() has added in the current folder its name as their label.
function(label_tests_of_folder)
  get_property(tests DIRECTORY PROPERTY TESTS)
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  foreach(test ${tests})
    get_property(label TEST ${test} PROPERTY LABELS)
    if(NOT label)
      set_tests_properties(${test} PROPERTIES LABELS ${folder})
    endif()
  endforeach()
endfunction()
