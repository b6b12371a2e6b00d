/* The set-up of the core before C++ code runs, in machine mode. */
  .section .first, "ax"
  .global reset
reset:
  .option push
  .option norelax
  la gp, __global_pointer$
  .option pop
  la sp, stack_top
  mv tp, zero
  la t0, trap
  csrw mtvec, t0
  /* Enables the floating-point unit. */
  li t0, 0x2000
  csrs mstatus, t0
  call start_program

  .balign 4
trap:
  la sp, stack_top
  call unexpected_trap
