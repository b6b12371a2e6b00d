# What all processors without an operating system have in common. Before it stands: TUMBLESIGHT_BOARD, a folder of
# hal/bare_metal.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES TUMBLESIGHT_BOARD)
