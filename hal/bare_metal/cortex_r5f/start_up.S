/* The vectors, and the set-up of the core before C++ code runs. */
  .syntax unified
  .arm

  .section .first, "ax", %progbits
  .global vectors
vectors:
  b reset
  b trap
  b trap
  b trap
  b trap
  b trap
  b trap
  b trap

  .text
  .type reset, %function
reset:
  ldr sp, =stack_top
  /* Enables the floating-point unit. */
  mrc p15, 0, r0, c1, c0, 2
  orr r0, r0, #0xf00000
  mcr p15, 0, r0, c1, c0, 2
  isb
  mov r0, #0x40000000
  vmsr fpexc, r0
  /* Starts the cycle counter from 0. */
  mov r0, #5
  mcr p15, 0, r0, c9, c12, 0
  mov r0, #0x80000000
  mcr p15, 0, r0, c9, c12, 1
  bl start_program

  .type trap, %function
trap:
  ldr sp, =stack_top
  bl unexpected_trap
