# cFE evaluates this file when it prepares a mission: a mission may have its own file of each of these names.
foreach(header tumblesight_app_msgids tumblesight_app_perfids)
  generate_config_includefile(FILE_NAME ${header}.h FALLBACK_FILE ${CMAKE_CURRENT_LIST_DIR}/config/default_${header}.h)
endforeach()
