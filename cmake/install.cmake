# cmake --install: the flight side as static libraries, headers and shipped models, for find_package(tumblesight).
# The package holds gnc, fsw/app and its C interface, the HAL interfaces, messages and packets, and the platforms hal/replay and hal/posix. Each
# library has the name that it has here, with the prefix tumblesight::. The programs: package.cmake.
include(GNUInstallDirs)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME tumblesight-dev)
include(CMakePackageConfigHelpers)

# Appends the library and the project's own libraries that it links to `result`.
function(collect_project_libraries library result)
  set(libraries ${${result}})
  if(NOT library IN_LIST libraries)
    list(APPEND libraries ${library})
    get_target_property(linked ${library} INTERFACE_LINK_LIBRARIES)
    foreach(other IN LISTS linked)
      string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" other "${other}")
      if(TARGET ${other})
        get_target_property(imported ${other} IMPORTED)
        if(NOT imported)
          collect_project_libraries(${other} libraries)
        endif()
      endif()
    endforeach()
  endif()
  set(${result} ${libraries} PARENT_SCOPE)
endfunction()

set(package_libraries "")
foreach(library fsw_app fsw_c hal_interfaces hal_packets hal_replay hal_posix)
  if(TARGET ${library})
    collect_project_libraries(${library} package_libraries)
  endif()
endforeach()
foreach(library IN LISTS package_libraries)
  add_library(tumblesight::${library} ALIAS ${library})
endforeach()

# All that C programs need in one archive, for builds that do not use CMake's package: cc … -ltumblesight
set(archive_libraries "")
collect_project_libraries(fsw_c archive_libraries)
set(archive_objects "")
foreach(library IN LISTS archive_libraries)
  get_target_property(type ${library} TYPE)
  if(type STREQUAL "STATIC_LIBRARY")
    list(APPEND archive_objects $<TARGET_OBJECTS:${library}>)
  endif()
endforeach()
add_library(tumblesight_archive STATIC ${archive_objects})
set_target_properties(tumblesight_archive PROPERTIES OUTPUT_NAME tumblesight LINKER_LANGUAGE CXX)
install(TARGETS tumblesight_archive ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/tumblesight)
set(package_models_dir ${CMAKE_INSTALL_DATADIR}/tumblesight/models)
install(TARGETS ${package_libraries} EXPORT tumblesight ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT tumblesight NAMESPACE tumblesight:: FILE tumblesight_targets.cmake DESTINATION ${package_folder})
# Includes are written from the project's root, so the headers keep their folders.
install(DIRECTORY gnc fsw hal DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tumblesight FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h" PATTERN "*.inc"
  PATTERN programs EXCLUDE PATTERN models EXCLUDE PATTERN bare_metal EXCLUDE PATTERN dds EXCLUDE PATTERN fake EXCLUDE)
install(FILES ${PROJECT_BINARY_DIR}/hal/messages/message_fields.inc
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tumblesight/hal/messages)
# Without the images that fsw/models/fetch_images writes.
install(DIRECTORY fsw/models/ DESTINATION ${package_models_dir} COMPONENT tumblesight FILES_MATCHING PATTERN "*.tsm"
  PATTERN "*.float32.tsm" EXCLUDE PATTERN "*_paper_rule.tsm" EXCLUDE)
configure_package_config_file(cmake/tumblesight-config.cmake.in ${PROJECT_BINARY_DIR}/cmake/tumblesight-config.cmake
  INSTALL_DESTINATION ${package_folder} PATH_VARS package_models_dir)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cmake/tumblesight-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/cmake/tumblesight-config.cmake
  ${PROJECT_BINARY_DIR}/cmake/tumblesight-config-version.cmake DESTINATION ${package_folder})
