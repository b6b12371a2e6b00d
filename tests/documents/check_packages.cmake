# cmake -DBUILD=<build folder> -DVERSION=<version> -P check_packages.cmake
# Makes the Debian packages and checks what they say and hold.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/run_or_fail.cmake)

function(expect_match pattern)
  if(NOT "${output}" MATCHES "${pattern}")
    message(FATAL_ERROR "'${pattern}' does not match:\n${output}")
  endif()
endfunction()

set(packages ${BUILD}/packages)
file(REMOVE_RECURSE ${packages})
get_filename_component(tools ${CMAKE_COMMAND} DIRECTORY)
run_or_fail(${tools}/cpack -G DEB --config ${BUILD}/CPackConfig.cmake -B ${packages} -D CPACK_DEBIAN_COMPRESSION_TYPE=none)
run_or_fail(dpkg --print-architecture)
string(STRIP "${output}" architecture)
set(programs ${packages}/tumblesight_${VERSION}_${architecture}.deb)
set(libraries ${packages}/tumblesight-dev_${VERSION}_${architecture}.deb)

run_or_fail(dpkg-deb --field ${programs})
expect_match("Depends: [^\n]*libc6 \\(>= ")
expect_match("Depends: [^\n]*libembree3")
expect_match("Section: science\n")
run_or_fail(dpkg-deb --contents ${programs})
foreach(file bin/tumblesight bin/tumblesight-simulate bin/flight share/tumblesight/models/near_shoemaker.tsm share/tumblesight/missions/1_near_shoemaker.toml
  share/tumblesight/sensors/paper.json share/doc/tumblesight/copyright
  share/doc/tumblesight/docs/tumblesight.xtce.xml share/doc/tumblesight/docs/verification.md)
  expect_match("root/root[^\n]* \\./usr/${file}\n")
endforeach()
run_or_fail(dpkg-deb --field ${libraries})
expect_match("Depends: tumblesight \\(= ${VERSION}\\), libeigen3-dev\n")
run_or_fail(dpkg-deb --contents ${libraries})
foreach(file lib/[^\n]*libfsw_app.a lib/[^\n]*cmake/tumblesight/tumblesight-config.cmake include/tumblesight/fsw/c/tumblesight_c.h
  share/doc/tumblesight-dev/copyright)
  expect_match(" \\./usr/${file}\n")
endforeach()
message(STATUS "the packages are complete")
