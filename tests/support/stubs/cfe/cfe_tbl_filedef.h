/* As cFE's: what its tools need to know of a table's source. */
#ifndef CFE_TBL_FILEDEF_H
#define CFE_TBL_FILEDEF_H

#include <stdint.h>

typedef struct {
  char ObjectName[64];
  char TableName[40];
  char Description[32];
  char TgtFilename[20];
  uint32_t ObjectSize;
} CFE_TBL_FileDef_t;

#define CFE_TBL_FILEDEF(Object, Table, Text, File) \
  extern const CFE_TBL_FileDef_t CFE_TBL_FileDef;  \
  const CFE_TBL_FileDef_t CFE_TBL_FileDef = {#Object, #Table, #Text, #File, (uint32_t)sizeof(Object)};

#endif /* CFE_TBL_FILEDEF_H */
