# RISC-V rv64gc (PolarFire SoC's U54), Linux.
include(${CMAKE_CURRENT_LIST_DIR}/require.cmake)
require_program(CMAKE_C_COMPILER riscv64-linux-gnu-gcc g++-riscv64-linux-gnu)
require_program(CMAKE_CXX_COMPILER riscv64-linux-gnu-g++ g++-riscv64-linux-gnu)
require_program(TUMBLESIGHT_QEMU qemu-riscv64 qemu-user)

set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR riscv64)
set(CMAKE_CXX_FLAGS_INIT "-march=rv64gc -mtune=sifive-7-series")
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
set(CMAKE_CROSSCOMPILING_EMULATOR "${TUMBLESIGHT_QEMU}")
