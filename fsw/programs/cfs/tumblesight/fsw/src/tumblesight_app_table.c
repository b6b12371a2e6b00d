#include "tumblesight_app_table.h"

#include "tumblesight_app.h"
#include "tumblesight_app_eventids.h"

/* cFE calls it before a loaded table is activated. */
static CFE_Status_t Validate(void* Table) {
  struct tumblesight_wrong_parameter Wrong;
  if (tumblesight_check_parameters(Table, &Wrong) == TUMBLESIGHT_OK) return CFE_SUCCESS;
  if (Wrong.highest > 0)
    CFE_EVS_SendEvent(TUMBLESIGHT_APP_TBL_VALUE_ERR_EID, CFE_EVS_EventType_ERROR,
                      "TUMBLESIGHT: table refused: %s is %lu, not in %lu ... %lu", Wrong.name,
                      (unsigned long)Wrong.value, (unsigned long)Wrong.lowest, (unsigned long)Wrong.highest);
  else
    CFE_EVS_SendEvent(TUMBLESIGHT_APP_TBL_VALUE_ERR_EID, CFE_EVS_EventType_ERROR,
                      "TUMBLESIGHT: table refused: %s is 0x%08lX", Wrong.name, (unsigned long)Wrong.value);
  return CFE_STATUS_VALIDATION_FAILURE;
}

/* Initial parameters take the place of a file that cannot be loaded. */
static CFE_Status_t LoadTable(void) {
  struct tumblesight_parameters Initial;
  const CFE_TBL_Handle_t Table = TUMBLESIGHT_APP_Data.Table;
  const CFE_Status_t Status = CFE_TBL_Load(Table, CFE_TBL_SRC_FILE, TUMBLESIGHT_APP_TABLE_FILE);
  if (Status >= CFE_SUCCESS) return CFE_SUCCESS;
  CFE_EVS_SendEvent(TUMBLESIGHT_APP_TBL_ERR_EID, CFE_EVS_EventType_ERROR,
                    "TUMBLESIGHT: RC = 0x%08lX, initial parameters in place of table file %s",
                    TUMBLESIGHT_APP_RC(Status), TUMBLESIGHT_APP_TABLE_FILE);
  tumblesight_initial_parameters(&Initial);
  return CFE_TBL_Load(Table, CFE_TBL_SRC_ADDRESS, &Initial);
}

void TUMBLESIGHT_APP_RegisterTable(void) {
  CFE_Status_t Status =
      CFE_TBL_Register(&TUMBLESIGHT_APP_Data.Table, "Parameters", sizeof(struct tumblesight_parameters),
                       CFE_TBL_OPT_DEFAULT, Validate);
  if (Status >= CFE_SUCCESS) Status = LoadTable();
  TUMBLESIGHT_APP_Data.HasTable = Status >= CFE_SUCCESS;
  if (!TUMBLESIGHT_APP_Data.HasTable)
    CFE_EVS_SendEvent(TUMBLESIGHT_APP_TBL_ERR_EID, CFE_EVS_EventType_ERROR,
                      "TUMBLESIGHT: no parameter table, RC = 0x%08lX: parameters stay as they are",
                      TUMBLESIGHT_APP_RC(Status));
}

static void UseTable(struct tumblesight_parameters* Parameters) {
  if (tumblesight_set_parameters(TUMBLESIGHT_APP_Data.App, Parameters) != TUMBLESIGHT_OK) {
    (void)Validate(Parameters); /* it changed after cFE validated it: says which field */
    return;
  }
  ++TUMBLESIGHT_APP_COUNTERS.TableUpdates;
  CFE_EVS_SendEvent(TUMBLESIGHT_APP_TBL_INF_EID, CFE_EVS_EventType_INFORMATION,
                    "TUMBLESIGHT: parameters of the table are in use");
}

void TUMBLESIGHT_APP_ManageTable(void) {
  void* Table = NULL;
  if (!TUMBLESIGHT_APP_Data.HasTable) return;
  (void)CFE_TBL_Manage(TUMBLESIGHT_APP_Data.Table);
  const CFE_Status_t Status = CFE_TBL_GetAddress(&Table, TUMBLESIGHT_APP_Data.Table);
  if (Status < CFE_SUCCESS) return; /* nothing was loaded */
  if (Status == CFE_TBL_INFO_UPDATED) UseTable(Table);
  (void)CFE_TBL_ReleaseAddress(TUMBLESIGHT_APP_Data.Table);
}
