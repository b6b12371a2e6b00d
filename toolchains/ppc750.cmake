# PowerPC 750 (RAD750), big-endian, Linux.
include(${CMAKE_CURRENT_LIST_DIR}/require.cmake)
require_program(CMAKE_C_COMPILER powerpc-linux-gnu-gcc g++-powerpc-linux-gnu)
require_program(CMAKE_CXX_COMPILER powerpc-linux-gnu-g++ g++-powerpc-linux-gnu)
require_program(TUMBLESIGHT_QEMU qemu-ppc qemu-user)

set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR ppc)
set(CMAKE_CXX_FLAGS_INIT "-mcpu=750 -fno-pie")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-static -no-pie")
set(CMAKE_CROSSCOMPILING_EMULATOR "${TUMBLESIGHT_QEMU};-cpu;750")
