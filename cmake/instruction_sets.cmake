# Inner loops beside the portable ones: on a desktop for all that its family of processors may have, chosen at start-up;
# on a target for what its compiler flags name.
include(CheckCXXSourceCompiles)
check_cxx_source_compiles("#if !defined(__x86_64__)\n#error\n#endif\nint main() {}" TUMBLESIGHT_X86_KERNELS)
check_cxx_source_compiles("#if !defined(__ARM_NEON)\n#error\n#endif\nint main() {}" TUMBLESIGHT_NEON_KERNELS)
check_cxx_source_compiles("#if !defined(__ARM_FEATURE_DOTPROD)\n#error\n#endif\nint main() {}"
  TUMBLESIGHT_DOT_PRODUCT_KERNELS)
check_cxx_source_compiles("#if !defined(__ARM_FEATURE_DSP) || defined(__ARM_NEON)\n#error\n#endif\nint main() {}"
  TUMBLESIGHT_DSP_KERNELS)
