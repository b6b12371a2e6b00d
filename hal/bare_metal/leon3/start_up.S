/* The trap table, the handlers of window overflow and underflow (eight register windows), and the set-up of the core
   before C++ code runs. */

#define PSR_FLOAT_PIL_SUPERVISOR 0x1fc0
#define PSR_TRAPS 0x20
#define WINDOWS 8

.macro trap_to handler
  ba \handler
  nop
  nop
  nop
.endm

  .section .first, "ax"
  .balign 4096
  .global trap_table
trap_table:
  trap_to reset                 /* 0x00 */
  .rept 4
  trap_to unexpected            /* 0x01 to 0x04 */
  .endr
  trap_to window_overflow       /* 0x05 */
  trap_to window_underflow      /* 0x06 */
  .rept 249
  trap_to unexpected            /* 0x07 to 0xff */
  .endr

  .text
reset:
  set trap_table, %g1
  wr %g1, %tbr
  wr %g0, 2, %wim               /* the next window is the invalid one */
  wr %g0, PSR_FLOAT_PIL_SUPERVISOR, %psr
  nop
  nop
  nop
  wr %g0, PSR_FLOAT_PIL_SUPERVISOR | PSR_TRAPS, %psr
  nop
  nop
  nop
  set stack_top - 96, %sp
  mov 0, %fp
  call start_program
  nop

/* Runs in the invalid window. Saves the window beyond it to its stack, which becomes the invalid one. */
window_overflow:
  mov %wim, %l3
  mov %g1, %l7
  srl %l3, 1, %g1
  sll %l3, WINDOWS - 1, %l4
  or %g1, %l4, %g1
  save
  wr %g1, 0, %wim
  nop
  nop
  nop
  std %l0, [%sp + 0]
  std %l2, [%sp + 8]
  std %l4, [%sp + 16]
  std %l6, [%sp + 24]
  std %i0, [%sp + 32]
  std %i2, [%sp + 40]
  std %i4, [%sp + 48]
  std %i6, [%sp + 56]
  restore
  mov %l7, %g1
  jmp %l1
  rett %l2

/* Runs two windows before the one to be restored from its stack. */
window_underflow:
  mov %wim, %l3
  sll %l3, 1, %l4
  srl %l3, WINDOWS - 1, %l5
  or %l4, %l5, %l4
  wr %l4, 0, %wim
  nop
  nop
  nop
  restore
  restore
  ldd [%sp + 0], %l0
  ldd [%sp + 8], %l2
  ldd [%sp + 16], %l4
  ldd [%sp + 24], %l6
  ldd [%sp + 32], %i0
  ldd [%sp + 40], %i2
  ldd [%sp + 48], %i4
  ldd [%sp + 56], %i6
  save
  save
  jmp %l1
  rett %l2

unexpected:
  wr %g0, 2, %wim
  wr %g0, PSR_FLOAT_PIL_SUPERVISOR | PSR_TRAPS, %psr
  nop
  nop
  nop
  set stack_top - 96, %sp
  call unexpected_trap
  nop

  .section .note.GNU-stack, "", %progbits
