# use_unity_build(<folder>): the programs and libraries of a folder and of those below it compile in groups of sources, so that the
# headers of a group are read once. Targets with UNITY_BUILD OFF are left out: their sources use the same name for different
# things.
function(use_unity_build folder)
  get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    get_target_property(unity_build ${target} UNITY_BUILD)
    if(type MATCHES "STATIC_LIBRARY|OBJECT_LIBRARY|EXECUTABLE" AND unity_build STREQUAL "unity_build-NOTFOUND")
      set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
    endif()
  endforeach()
  get_property(folders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(subfolder IN LISTS folders)
    use_unity_build(${subfolder})
  endforeach()
endfunction()
