# Cortex-A9 (Zynq-7000), Linux.
include(${CMAKE_CURRENT_LIST_DIR}/require.cmake)
require_program(CMAKE_C_COMPILER arm-linux-gnueabihf-gcc g++-arm-linux-gnueabihf)
require_program(CMAKE_CXX_COMPILER arm-linux-gnueabihf-g++ g++-arm-linux-gnueabihf)
require_program(TUMBLESIGHT_QEMU qemu-arm qemu-user)

set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_CXX_FLAGS_INIT "-mcpu=cortex-a9 -mfpu=neon -mfloat-abi=hard")
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
set(CMAKE_CROSSCOMPILING_EMULATOR "${TUMBLESIGHT_QEMU};-cpu;cortex-a9")
