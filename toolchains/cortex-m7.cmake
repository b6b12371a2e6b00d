# Cortex-M7 (SAMRH71 class) without an operating system; QEMU's board mps2-an500.
include(${CMAKE_CURRENT_LIST_DIR}/require.cmake)
require_program(CMAKE_C_COMPILER arm-none-eabi-gcc "gcc-arm-none-eabi libstdc++-arm-none-eabi-newlib")
require_program(CMAKE_CXX_COMPILER arm-none-eabi-g++ "gcc-arm-none-eabi libstdc++-arm-none-eabi-newlib")
require_program(TUMBLESIGHT_QEMU qemu-system-arm qemu-system-arm)

set(TUMBLESIGHT_BOARD cortex_m7)
include(${CMAKE_CURRENT_LIST_DIR}/bare_metal.cmake)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(flags "-mcpu=cortex-m7 -mthumb -mfpu=fpv5-d16 -mfloat-abi=hard")
set(CMAKE_CXX_FLAGS_INIT "${flags}")
set(CMAKE_ASM_FLAGS_INIT "${flags}")
set(CMAKE_CROSSCOMPILING_EMULATOR "${TUMBLESIGHT_QEMU};-M;mps2-an500;-display;none;-monitor;none;-serial;none\
;-semihosting-config;enable=on,target=native;-icount;shift=0;-kernel")
