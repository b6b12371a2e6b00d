# Cortex-A53 (Zynq UltraScale+), Linux.
include(${CMAKE_CURRENT_LIST_DIR}/require.cmake)
require_program(CMAKE_C_COMPILER aarch64-linux-gnu-gcc g++-aarch64-linux-gnu)
require_program(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++ g++-aarch64-linux-gnu)
require_program(TUMBLESIGHT_QEMU qemu-aarch64 qemu-user)

set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_FLAGS_INIT "-mcpu=cortex-a53")
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
set(CMAKE_CROSSCOMPILING_EMULATOR "${TUMBLESIGHT_QEMU};-cpu;cortex-a53")
