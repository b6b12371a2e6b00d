# cFE evaluates this file when it prepares a processor: a mission may have its own file of this name.
generate_config_includefile(FILE_NAME tumblesight_app_platform_cfg.h
  FALLBACK_FILE ${CMAKE_CURRENT_LIST_DIR}/config/default_tumblesight_app_platform_cfg.h)
