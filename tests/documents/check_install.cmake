# cmake -DBUILD=<build folder> -DEXAMPLES=<this folder> -DFRAMES=<recording> -DGENERATOR=<generator> -P check_install.cmake
# Installs the package, builds the examples against it and runs the first one.
cmake_minimum_required(VERSION 3.25)

include(${CMAKE_CURRENT_LIST_DIR}/run_or_fail.cmake)

# The smallest integration in C runs ten cycles in RUN, without a frame.
function(check_smallest program)
  run_or_fail(${program})
  string(REGEX MATCHALL "cycle [0-9]+: mode 2, validity 2, state" cycles "${output}")
  list(LENGTH cycles count)
  if(NOT count EQUAL 10)
    message(FATAL_ERROR "expected 10 cycles in RUN without a frame from ${program}, found ${count}:\n${output}")
  endif()
endfunction()

set(prefix ${BUILD}/installed)
set(examples ${BUILD}/installed_examples)
file(REMOVE_RECURSE ${prefix} ${examples} ${prefix}_elsewhere)
run_or_fail(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
# Nothing in it tells where it was built.
get_filename_component(source ${CMAKE_CURRENT_LIST_DIR}/../.. ABSOLUTE)
execute_process(COMMAND grep -rlF -e ${source}/fsw -e ${source}/gnc -e ${source}/hal -e ${source}/sim ${prefix}
  OUTPUT_VARIABLE with_path)
if(with_path)
  message(FATAL_ERROR "these files contain a path of the source tree:\n${with_path}")
endif()
# The package must not depend on the folder that it was installed to.
file(RENAME ${prefix} ${prefix}_elsewhere)
run_or_fail(${CMAKE_COMMAND} -S ${EXAMPLES} -B ${examples} -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Release
  -DCMAKE_C_COMPILER=${CC} -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${prefix}_elsewhere)
run_or_fail(${CMAKE_COMMAND} --build ${examples})
run_or_fail(${examples}/attitude_from_frames ${prefix}_elsewhere/share/tumblesight/models/near_shoemaker.tsm ${FRAMES})
string(REGEX MATCHALL "frame +[0-9]+: q_lrf_trf( +-?[01]\\.[0-9]+)+, expected error" frames "${output}")
list(LENGTH frames count)
if(NOT count EQUAL 20)
  message(FATAL_ERROR "expected attitudes of 20 frames, found ${count}:\n${output}")
endif()
check_smallest(${examples}/smallest)
# Without CMake's package: one archive, the C compiler, no C++ run-time library.
file(GLOB_RECURSE archive ${prefix}_elsewhere/libtumblesight.a)
get_filename_component(archive_folder "${archive}" DIRECTORY)
run_or_fail(${CC} -std=c99 -pedantic -Wall -Wextra -Werror -I${prefix}_elsewhere/include/tumblesight
  -DMODEL_IMAGE="${prefix}_elsewhere/share/tumblesight/models/near_shoemaker.tsm" ${EXAMPLES}/smallest.c ${EXAMPLES}/board.c
  ${EXAMPLES}/model_image.S -L${archive_folder} -ltumblesight -o ${examples}/smallest_by_hand)
check_smallest(${examples}/smallest_by_hand)
message(STATUS "the installed package builds the examples; all of them run")
