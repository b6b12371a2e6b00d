# Cortex-R5F (Zynq UltraScale+, TMS570 class) without an operating system; a bare core in QEMU.
include(${CMAKE_CURRENT_LIST_DIR}/require.cmake)
require_program(CMAKE_C_COMPILER arm-none-eabi-gcc "gcc-arm-none-eabi libstdc++-arm-none-eabi-newlib")
require_program(CMAKE_CXX_COMPILER arm-none-eabi-g++ "gcc-arm-none-eabi libstdc++-arm-none-eabi-newlib")
require_program(TUMBLESIGHT_QEMU qemu-system-arm qemu-system-arm)

set(TUMBLESIGHT_BOARD cortex_r5f)
include(${CMAKE_CURRENT_LIST_DIR}/bare_metal.cmake)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(flags "-mcpu=cortex-r5 -marm -mfpu=vfpv3-d16 -mfloat-abi=hard")
set(CMAKE_CXX_FLAGS_INIT "${flags}")
set(CMAKE_ASM_FLAGS_INIT "${flags}")
# QEMU's machine "none" has no option -kernel.
set(CMAKE_CROSSCOMPILING_EMULATOR "${CMAKE_CURRENT_LIST_DIR}/cortex-r5f-emulator;${TUMBLESIGHT_QEMU}")
