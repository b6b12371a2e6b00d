# Instruction sets for which inner loops are built in addition to the portable ones. On a desktop: all those of the
# processor family, selected at start-up. On a target processor: those that its compiler flags enable.
include(CheckCXXSourceCompiles)
check_cxx_source_compiles("#if !defined(__x86_64__)\n#error\n#endif\nint main() {}" TUMBLESIGHT_X86_KERNELS)
check_cxx_source_compiles("#if !defined(__ARM_NEON)\n#error\n#endif\nint main() {}" TUMBLESIGHT_NEON_KERNELS)
check_cxx_source_compiles("#if !defined(__ARM_FEATURE_DOTPROD)\n#error\n#endif\nint main() {}"
  TUMBLESIGHT_DOT_PRODUCT_KERNELS)
check_cxx_source_compiles("#if !defined(__ARM_FEATURE_DSP) || defined(__ARM_NEON)\n#error\n#endif\nint main() {}"
  TUMBLESIGHT_DSP_KERNELS)
