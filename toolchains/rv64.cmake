# RISC-V rv64gc without an operating system; QEMU's board virt. Debian has no libstdc++ for it: the headers are
# those of newlib for Arm, and the library is not linked.
include(${CMAKE_CURRENT_LIST_DIR}/require.cmake)
require_program(CMAKE_C_COMPILER riscv64-unknown-elf-gcc "gcc-riscv64-unknown-elf picolibc-riscv64-unknown-elf")
require_program(CMAKE_CXX_COMPILER riscv64-unknown-elf-g++ "gcc-riscv64-unknown-elf picolibc-riscv64-unknown-elf")
require_program(TUMBLESIGHT_QEMU qemu-system-riscv64 qemu-system-misc)
find_path(TUMBLESIGHT_CXX_HEADERS type_traits PATHS /usr/include/newlib/c++/12.2.1 NO_DEFAULT_PATH)
if(NOT TUMBLESIGHT_CXX_HEADERS)
  message(FATAL_ERROR "${CMAKE_CURRENT_LIST_FILE}\n  needs libstdc++'s headers; on Debian: apt-get install "
    "libstdc++-arm-none-eabi-newlib")
endif()

set(TUMBLESIGHT_BOARD rv64)
include(${CMAKE_CURRENT_LIST_DIR}/bare_metal.cmake)
set(CMAKE_SYSTEM_PROCESSOR riscv64)
set(flags "-march=rv64gc -mabi=lp64d -mcmodel=medany -mtune=sifive-7-series --specs=picolibc.specs")
set(CMAKE_CXX_FLAGS_INIT "${flags} -nostdinc++ -isystem ${TUMBLESIGHT_CXX_HEADERS} \
-isystem ${TUMBLESIGHT_CXX_HEADERS}/arm-none-eabi")
set(CMAKE_ASM_FLAGS_INIT "${flags}")
set(CMAKE_CROSSCOMPILING_EMULATOR "${TUMBLESIGHT_QEMU};-M;virt;-bios;none;-display;none;-monitor;none;-serial;stdio\
;-icount;shift=0;-kernel")
