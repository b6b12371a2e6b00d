# The kernels built in addition to the portable ones. x86-64: all of the family, selected at start-up. Others: those of
# the instruction sets that the compiler flags select.
include(CheckCXXSourceCompiles)
check_cxx_source_compiles("#if !defined(__x86_64__)\n#error\n#endif\nint main() {}" TUMBLESIGHT_X86_KERNELS)
check_cxx_source_compiles("#if !defined(__ARM_NEON)\n#error\n#endif\nint main() {}" TUMBLESIGHT_NEON_KERNELS)
check_cxx_source_compiles("#if !defined(__ARM_FEATURE_DOTPROD)\n#error\n#endif\nint main() {}"
  TUMBLESIGHT_DOT_PRODUCT_KERNELS)
check_cxx_source_compiles("#if !defined(__ARM_FEATURE_DSP) || defined(__ARM_NEON)\n#error\n#endif\nint main() {}"
  TUMBLESIGHT_DSP_KERNELS)
