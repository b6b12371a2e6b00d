#include "tests/support/stubs/cfe/cfe_stub.hpp"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>

namespace tumblesight::cfe {
namespace {

constexpr std::size_t kPrimaryHeaderBytes = 6;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

Cfe& instance() {
  static Cfe cfe;
  return cfe;
}

std::size_t size_of(const void* message) {
  std::uint8_t header[kPrimaryHeaderBytes];
  std::memcpy(header, message, sizeof header);
  return kPrimaryHeaderBytes + 1 + static_cast<std::size_t>(header[4] * 256 + header[5]);
}

void put_header(std::uint8_t* bytes, std::uint32_t message_id, std::size_t size_bytes) {
  bytes[0] = static_cast<std::uint8_t>(message_id >> 8);
  bytes[1] = static_cast<std::uint8_t>(message_id & 0xFF);
  bytes[2] = 0xC0;
  bytes[3] = 0;
  bytes[4] = static_cast<std::uint8_t>((size_bytes - kPrimaryHeaderBytes - 1) >> 8);
  bytes[5] = static_cast<std::uint8_t>((size_bytes - kPrimaryHeaderBytes - 1) & 0xFF);
}

std::string in_hexadecimal(std::uint32_t value) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%04X", static_cast<unsigned>(value));
  return text;
}

std::string formatted(const char* format, va_list arguments) {
  char text[1024];
  std::vsnprintf(text, sizeof text, format, arguments);
  return text;
}

SentMessage sent_message(const void* message, bool is_origination) {
  const auto* const bytes = static_cast<const std::uint8_t*>(message);
  return {Bytes(bytes, bytes + size_of(message)), is_origination};
}

}  // namespace

Cfe& the_cfe() {
  return instance();
}

void restart_cfe() {
  instance() = Cfe{};
}

std::optional<CFE_Status_t> Cfe::failure(const std::string& call) {
  ++calls[call];
  const auto found = failing.find(call);
  if (found == failing.end()) return {};
  return found->second;
}

Bytes make_message(std::uint32_t message_id, std::size_t size_bytes) {
  Bytes bytes(size_bytes);
  put_header(bytes.data(), message_id, size_bytes);
  return bytes;
}

CFE_TIME_SysTime_t to_cfe_time(std::int64_t time_ns) {
  const auto rest_ns = static_cast<std::uint64_t>(time_ns % kSecond_ns);
  return {static_cast<uint32>(time_ns / kSecond_ns),
          static_cast<uint32>(((rest_ns << 32) + kSecond_ns / 2) / kSecond_ns)};
}

CFE_Status_t Cfe::load_table(const Bytes& bytes) {
  Bytes loaded = bytes;
  loaded.resize(table_bytes);
  const CFE_Status_t status = validate(loaded.data());
  if (status != CFE_SUCCESS) return status;
  table = loaded;
  table_is_new = true;
  return CFE_SUCCESS;
}

}  // namespace tumblesight::cfe

using namespace tumblesight::cfe;

// Returns from a call that was made to fail.
#define RETURN_IF_FAILING(call) \
  if (const auto status = the_cfe().failure(call)) return *status

int32 OS_OpenCreate(osal_id_t* File, const char* Path, int32, int32) {
  RETURN_IF_FAILING("OS_OpenCreate");
  const auto found = the_cfe().files.find(Path);
  if (found == the_cfe().files.end()) return OS_ERROR;
  *File = static_cast<osal_id_t>(the_cfe().open_files.size() + 1);
  the_cfe().open_files[*File] = {found->second, 0};
  ++the_cfe().files_open;
  return OS_SUCCESS;
}

int32 OS_read(osal_id_t File, void* To, size_t Count) {
  RETURN_IF_FAILING("OS_read");
  Cfe::OpenFile& file = the_cfe().open_files.at(File);
  const std::size_t count = std::min({Count, file.bytes.size() - file.at, the_cfe().most_bytes_per_read});
  std::memcpy(To, file.bytes.data() + file.at, count);
  file.at += count;
  return static_cast<int32>(count);
}

int32 OS_close(osal_id_t) {
  --the_cfe().files_open;
  return OS_SUCCESS;
}

int32 OS_TaskDelay(uint32 Milliseconds) {
  the_cfe().delays_ms.push_back(Milliseconds);
  the_cfe().met_ns += std::int64_t{Milliseconds} * 1'000'000;
  if (the_cfe().late_ns.empty()) return OS_SUCCESS;
  the_cfe().met_ns += the_cfe().late_ns.front();
  the_cfe().late_ns.pop_front();
  return OS_SUCCESS;
}

void CFE_PSP_GetTime(OS_time_t* Time) {
  Time->ticks = 10'000 * ++the_cfe().calls["CFE_PSP_GetTime"];
}

CFE_TIME_SysTime_t CFE_TIME_GetMET() {
  return to_cfe_time(the_cfe().met_ns);
}

uint32 CFE_TIME_Sub2MicroSecs(uint32 Subseconds) {
  return static_cast<uint32>(std::uint64_t{Subseconds} * 1'000'000 >> 32);
}

CFE_Status_t CFE_MSG_Init(CFE_MSG_Message_t* Message, CFE_SB_MsgId_t Id, CFE_MSG_Size_t Size) {
  std::memset(static_cast<void*>(Message), 0, Size);
  put_header(Message->Byte, Id.Value, Size);
  return CFE_SUCCESS;
}

CFE_Status_t CFE_MSG_GetMsgId(const CFE_MSG_Message_t* Message, CFE_SB_MsgId_t* Id) {
  Id->Value = static_cast<CFE_SB_MsgId_Atom_t>(Message->Byte[0] << 8 | Message->Byte[1]);
  return CFE_SUCCESS;
}

CFE_Status_t CFE_MSG_GetSize(const CFE_MSG_Message_t* Message, CFE_MSG_Size_t* Size) {
  *Size = size_of(Message);
  return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_CreatePipe(CFE_SB_PipeId_t* Pipe, uint16 Depth, const char*) {
  RETURN_IF_FAILING("CFE_SB_CreatePipe");
  *Pipe = 1;
  the_cfe().pipe_depth = Depth;
  return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_SubscribeEx(CFE_SB_MsgId_t Id, CFE_SB_PipeId_t, CFE_SB_Qos_t, uint16 Limit) {
  RETURN_IF_FAILING("CFE_SB_SubscribeEx:" + in_hexadecimal(Id.Value));
  the_cfe().message_limits[Id.Value] = Limit;
  return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_ReceiveBuffer(CFE_SB_Buffer_t** Buffer, CFE_SB_PipeId_t, int32) {
  RETURN_IF_FAILING("CFE_SB_ReceiveBuffer");
  Cfe& cfe = the_cfe();
  const Cfe::Delivery next = cfe.script.front();
  cfe.script.pop_front();
  if (next.before) next.before();
  cfe.receive_buffer.assign(next.message.size() / sizeof(CFE_SB_Buffer_t) + 1, CFE_SB_Buffer_t{});
  std::memcpy(cfe.receive_buffer.data(), next.message.data(), next.message.size());
  *Buffer = cfe.receive_buffer.data();
  return CFE_SUCCESS;
}

CFE_SB_Buffer_t* CFE_SB_AllocateMessageBuffer(size_t Size) {
  if (!the_cfe().has_buffers) return nullptr;
  ++the_cfe().buffers_in_use;
  the_cfe().send_buffers.emplace_back(Size / sizeof(CFE_SB_Buffer_t) + 1);
  return the_cfe().send_buffers.back().data();
}

CFE_Status_t CFE_SB_ReleaseMessageBuffer(CFE_SB_Buffer_t*) {
  --the_cfe().buffers_in_use;
  return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_TransmitBuffer(CFE_SB_Buffer_t* Buffer, bool IsOrigination) {
  RETURN_IF_FAILING("CFE_SB_TransmitBuffer");
  --the_cfe().buffers_in_use;
  the_cfe().sent.push_back(sent_message(Buffer, IsOrigination));
  return CFE_SUCCESS;
}

CFE_Status_t CFE_SB_TransmitMsg(const CFE_MSG_Message_t* Message, bool IsOrigination) {
  RETURN_IF_FAILING("CFE_SB_TransmitMsg");
  the_cfe().sent.push_back(sent_message(Message, IsOrigination));
  return CFE_SUCCESS;
}

void CFE_SB_TimeStampMsg(CFE_MSG_Message_t*) {
  ++the_cfe().calls["CFE_SB_TimeStampMsg"];
}

void CFE_ES_PerfLogEntry(uint32 Marker) {
  the_cfe().perf_log.push_back(Marker);
}

void CFE_ES_PerfLogExit(uint32 Marker) {
  the_cfe().perf_log.push_back(Marker | 0x80000000U);
}

bool CFE_ES_RunLoop(uint32* RunStatus) {
  Cfe& cfe = the_cfe();
  if (*RunStatus != CFE_ES_RunStatus_APP_RUN) return false;
  return cfe.pipe_depth > 0 ? !cfe.script.empty() : cfe.periods-- > 0;
}

void CFE_ES_ExitApp(uint32 ExitStatus) {
  the_cfe().exit_status = ExitStatus;
}

int32 CFE_ES_GetResetType(uint32* Subtype) {
  *Subtype = the_cfe().reset_subtype;
  return the_cfe().reset_type;
}

CFE_Status_t CFE_ES_WaitForSystemState(uint32, uint32) {
  return the_cfe().is_operational ? CFE_SUCCESS : CFE_ES_OPERATION_TIMED_OUT;
}

CFE_Status_t CFE_ES_WriteToSysLog(const char* Format, ...) {
  va_list arguments;
  va_start(arguments, Format);
  the_cfe().system_log.push_back(formatted(Format, arguments));
  va_end(arguments);
  return CFE_SUCCESS;
}

CFE_Status_t CFE_ES_RegisterCDS(CFE_ES_CDSHandle_t* Handle, size_t Size, const char* Name) {
  RETURN_IF_FAILING(std::string("CFE_ES_RegisterCDS:") + Name);
  Cfe& cfe = the_cfe();
  cfe.stored_names.emplace_back(Name);
  *Handle = static_cast<CFE_ES_CDSHandle_t>(cfe.stored_names.size() - 1);
  const auto found = cfe.stored.find(Name);
  if (found != cfe.stored.end()) return CFE_ES_CDS_ALREADY_EXISTS;
  cfe.stored[Name] = std::nullopt;
  cfe.calls[std::string("size of ") + Name] = static_cast<int>(Size);
  return CFE_SUCCESS;
}

CFE_Status_t CFE_ES_CopyToCDS(CFE_ES_CDSHandle_t Handle, const void* From) {
  RETURN_IF_FAILING("CFE_ES_CopyToCDS");
  const std::string& name = the_cfe().stored_names.at(Handle);
  const auto* const bytes = static_cast<const std::uint8_t*>(From);
  the_cfe().stored[name] = Bytes(bytes, bytes + 256);
  return CFE_SUCCESS;
}

// A block that was never written has no checksum.
CFE_Status_t CFE_ES_RestoreFromCDS(void* To, CFE_ES_CDSHandle_t Handle) {
  RETURN_IF_FAILING("CFE_ES_RestoreFromCDS");
  const std::optional<Bytes>& block = the_cfe().stored.at(the_cfe().stored_names.at(Handle));
  if (!block) return CFE_ES_CDS_BLOCK_CRC_ERR;
  std::memcpy(To, block->data(), block->size());
  return CFE_SUCCESS;
}

CFE_Status_t CFE_EVS_Register(const void* Filters, uint16 Count, uint16) {
  RETURN_IF_FAILING("CFE_EVS_Register");
  const auto* const filters = static_cast<const CFE_EVS_BinFilter_t*>(Filters);
  the_cfe().filters.assign(filters, filters + Count);
  return CFE_SUCCESS;
}

CFE_Status_t CFE_EVS_SendEvent(uint16 Id, uint16 Type, const char* Format, ...) {
  va_list arguments;
  va_start(arguments, Format);
  the_cfe().events.push_back({Id, Type, formatted(Format, arguments)});
  va_end(arguments);
  return CFE_SUCCESS;
}

CFE_Status_t CFE_TBL_Register(CFE_TBL_Handle_t* Handle, const char*, size_t Size, uint16,
                              CFE_TBL_CallbackFuncPtr_t Validate) {
  RETURN_IF_FAILING("CFE_TBL_Register");
  *Handle = 1;
  the_cfe().validate = Validate;
  the_cfe().table_bytes = Size;
  return CFE_SUCCESS;
}

CFE_Status_t CFE_TBL_Load(CFE_TBL_Handle_t, CFE_TBL_SrcEnum_t Source, const void* From) {
  if (Source == CFE_TBL_SRC_FILE) {
    RETURN_IF_FAILING(std::string("CFE_TBL_Load:") + static_cast<const char*>(From));
    return the_cfe().load_table(the_cfe().table_file);
  }
  RETURN_IF_FAILING("CFE_TBL_Load:address");
  const auto* const bytes = static_cast<const std::uint8_t*>(From);
  return the_cfe().load_table(Bytes(bytes, bytes + the_cfe().table_bytes));
}

CFE_Status_t CFE_TBL_Manage(CFE_TBL_Handle_t) {
  ++the_cfe().calls["CFE_TBL_Manage"];
  return CFE_SUCCESS;
}

CFE_Status_t CFE_TBL_GetAddress(void** Address, CFE_TBL_Handle_t) {
  RETURN_IF_FAILING("CFE_TBL_GetAddress");
  if (!the_cfe().table) return CFE_TBL_ERR_NEVER_LOADED;
  ++the_cfe().addresses_held;
  *Address = the_cfe().table->data();
  const bool is_new = the_cfe().table_is_new;
  the_cfe().table_is_new = false;
  return is_new ? CFE_TBL_INFO_UPDATED : CFE_SUCCESS;
}

CFE_Status_t CFE_TBL_ReleaseAddress(CFE_TBL_Handle_t) {
  --the_cfe().addresses_held;
  return CFE_SUCCESS;
}
