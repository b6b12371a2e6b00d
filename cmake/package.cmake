# The programs with the files that ship with them, and the Debian packages that CPack makes: tumblesight, and tumblesight-dev with
# what install.cmake installs. Debian's folder for libraries needs the preset deb: its prefix is /usr.
set(data_folder ${CMAKE_INSTALL_DATADIR}/tumblesight)
get_property(tool GLOBAL PROPERTY TUMBLESIGHT_TOOL)
foreach(program ${tool} flight flight_float32)
  if(TARGET ${program})
    install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tumblesight)
  endif()
endforeach()
install(DIRECTORY sim/world/target/missions DESTINATION ${data_folder} COMPONENT tumblesight)
install(DIRECTORY sim/world/sensor/descriptions/ DESTINATION ${data_folder}/sensors COMPONENT tumblesight)
# For --numerics float32 and `tumblesight bench`; the other images in float32 are only in the repository's history.
install(FILES fsw/models/near_shoemaker.float32.tsm DESTINATION ${data_folder}/models COMPONENT tumblesight)
install(PROGRAMS hal/dds/make_security DESTINATION ${data_folder} COMPONENT tumblesight)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT tumblesight)
# Documents that only repeat what code and tests say: the packets for ground systems, and what verifies each requirement.
find_package(Python3 QUIET COMPONENTS Interpreter)
if(Python3_Interpreter_FOUND)
  foreach(document xtce:tumblesight.xtce.xml check_requirements:verification.md)
    string(REGEX MATCH "(.*):(.*)" document ${document})
    install(CODE "
      set(document \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DOCDIR}/docs/${CMAKE_MATCH_2}\")
      execute_process(COMMAND \"${Python3_EXECUTABLE}\" -B
        \"${PROJECT_SOURCE_DIR}/tests/documents/${CMAKE_MATCH_1}.py\" --write \"\$ENV{DESTDIR}\${document}\"
        COMMAND_ERROR_IS_FATAL ANY)
      list(APPEND CMAKE_INSTALL_MANIFEST_FILES \"\${document}\")" COMPONENT tumblesight)
  endforeach()
endif()
install(FILES cmake/README.installed DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME README COMPONENT tumblesight)
install(FILES LICENSES/Apache-2.0.txt DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT tumblesight)
install(FILES LICENSES/Apache-2.0.txt DESTINATION ${CMAKE_INSTALL_DOCDIR}-dev RENAME copyright COMPONENT tumblesight-dev)

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL tumblesight tumblesight-dev)
set(CPACK_PACKAGE_VENDOR Tumblesight)
set(CPACK_PACKAGE_CONTACT Tumblesight)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)  # <package>_<version>_<architecture>.deb
set(CPACK_DEBIAN_TUMBLESIGHT_PACKAGE_NAME tumblesight)
set(CPACK_DEBIAN_TUMBLESIGHT_PACKAGE_SECTION science)
set(CPACK_DEBIAN_TUMBLESIGHT_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_TUMBLESIGHT_PACKAGE_RECOMMENDS "libjs-dygraphs, libjs-three")  # the page of `tumblesight console`
set(CPACK_DEBIAN_TUMBLESIGHT_PACKAGE_SUGGESTS openssl)                          # make_security
set(CPACK_DEBIAN_TUMBLESIGHT_DESCRIPTION "attitude of tumbling spacecraft from flash-LiDAR frames
The flight application on a desktop (flight), the simulator and the ground tool
(tumblesight), with the models, missions and sensors that ship.")
set(CPACK_DEBIAN_TUMBLESIGHT-DEV_PACKAGE_NAME tumblesight-dev)
set(CPACK_DEBIAN_TUMBLESIGHT-DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_TUMBLESIGHT-DEV_PACKAGE_DEPENDS "tumblesight (= ${PROJECT_VERSION}), libeigen3-dev")
set(CPACK_DEBIAN_TUMBLESIGHT-DEV_DESCRIPTION "attitude of tumbling spacecraft from flash-LiDAR frames: libraries
Static libraries and headers of the flight software, for find_package(tumblesight)
in CMake.")
include(CPack)
