/* The model image and the recorded frames as bytes. CMakeLists.txt selects the files. */

  .section .model_image, "a"
  .balign 64
  .global tumblesight_model_image, tumblesight_model_image_end
tumblesight_model_image:
  .incbin TUMBLESIGHT_MODEL_IMAGE
tumblesight_model_image_end:

  .section .recording, "a"
  .balign 4
  .global tumblesight_recording, tumblesight_recording_end
tumblesight_recording:
  .incbin TUMBLESIGHT_RECORDING
tumblesight_recording_end:

#if defined(__linux__) && defined(__ELF__)
  .section .note.GNU-stack, "", %progbits
#endif
