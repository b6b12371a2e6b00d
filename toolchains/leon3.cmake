# LEON3 (GR712RC class; SPARC V8, big-endian) without an operating system; QEMU's board leon3_generic. The compiler is
# Debian's for 64-bit SPARC in its 32-bit mode. With the workarounds for the errata of GR712RC.
include(${CMAKE_CURRENT_LIST_DIR}/require.cmake)
require_program(CMAKE_C_COMPILER sparc64-linux-gnu-gcc "g++-sparc64-linux-gnu libc6-dev-sparc-sparc64-cross")
require_program(CMAKE_CXX_COMPILER sparc64-linux-gnu-g++ "g++-sparc64-linux-gnu libc6-dev-sparc-sparc64-cross")
require_program(TUMBLESIGHT_QEMU qemu-system-sparc qemu-system-sparc)

set(TUMBLESIGHT_BOARD leon3)
include(${CMAKE_CURRENT_LIST_DIR}/bare_metal.cmake)
set(CMAKE_SYSTEM_PROCESSOR sparc)
set(flags "-m32 -mcpu=leon3 -mfix-gr712rc -mhard-float -fno-pic -fno-pie -fno-stack-protector")
set(CMAKE_CXX_FLAGS_INIT "${flags}")
set(CMAKE_ASM_FLAGS_INIT "${flags}")
set(CMAKE_CROSSCOMPILING_EMULATOR "${TUMBLESIGHT_QEMU};-M;leon3_generic;-m;64M;-display;none;-monitor;none;-serial;stdio\
;-icount;shift=0;-kernel")
