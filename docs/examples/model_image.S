/* The model image in read-only memory, aligned as the flight application requires it. */
  .section .model_image, "a"
  .balign 64
  .global model_image, model_image_end
model_image:
  .incbin MODEL_IMAGE
model_image_end:

#if defined(__linux__) && defined(__ELF__)
  .section .note.GNU-stack, "", %progbits
#endif
