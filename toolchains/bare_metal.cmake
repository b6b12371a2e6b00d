# Common to all processors without an operating system. Set TUMBLESIGHT_BOARD, the name of a folder in hal/bare_metal,
# before including it.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES TUMBLESIGHT_BOARD)
