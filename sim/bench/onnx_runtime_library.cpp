#include "sim/bench/onnx_runtime_library.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "sim/host/program_files.hpp"

namespace tumblesight::sim {
namespace {

using Object = OnnxRuntimeLibrary::Object;

struct Base {
  const void* const* (*table)(std::uint32_t version);
  const char* (*version_string)();
};

// The oldest interface version with all functions used here. Later libraries still provide its table.
constexpr std::uint32_t kTableVersion = 11;

// Indices in the table.
constexpr int kGetErrorMessage = 2;
constexpr int kCreateEnv = 3;
constexpr int kCreateSessionFromArray = 8;
constexpr int kRun = 9;
constexpr int kCreateSessionOptions = 10;
constexpr int kSetSessionExecutionMode = 13;
constexpr int kSetSessionGraphOptimizationLevel = 23;
constexpr int kSetIntraOpNumThreads = 24;
constexpr int kSetInterOpNumThreads = 25;
constexpr int kCreateTensorWithData = 49;
constexpr int kCreateCpuMemoryInfo = 69;
constexpr int kReleaseEnv = 92;
constexpr int kReleaseStatus = 93;
constexpr int kReleaseMemoryInfo = 94;
constexpr int kReleaseSession = 95;
constexpr int kReleaseValue = 96;
constexpr int kReleaseSessionOptions = 100;

// Values of its enumerations.
constexpr int kSequential = 0;
constexpr int kAllOptimizations = 99;
constexpr int kErrorsOnly = 3;
constexpr int kFloat = 1;
constexpr int kUint8 = 2;
constexpr int kDeviceAllocator = 0;
constexpr int kDefaultMemory = 0;

#ifdef __aarch64__
constexpr const char* kNodeArchitecture = "arm64";
#else
constexpr const char* kNodeArchitecture = "x64";
#endif

// build/node_modules/onnxruntime-node/bin/napi-v*/linux/<architecture>/libonnxruntime.so.1
void add_npm_libraries(std::vector<std::string>& candidates) {
  namespace fs = std::filesystem;
  std::error_code none;
  for (const auto& entry :
       fs::directory_iterator(program_files().root + "/build/node_modules/onnxruntime-node/bin", none)) {
    const fs::path library = entry.path() / "linux" / kNodeArchitecture / "libonnxruntime.so.1";
    if (fs::exists(library, none)) candidates.push_back(library.string());
  }
}

std::vector<std::string> candidates_for(const std::string& path) {
  if (!path.empty()) return {path};
  const char* const named = std::getenv("TUMBLESIGHT_ONNXRUNTIME");
  if (named != nullptr && *named != '\0') return {named};
  std::vector<std::string> candidates;
  add_npm_libraries(candidates);
  candidates.insert(candidates.end(), {"libonnxruntime.so.1", "libonnxruntime.so"});
  return candidates;
}

}  // namespace

// Never unloaded: its threads and thread-local objects would outlive the library.
std::unique_ptr<OnnxRuntimeLibrary> OnnxRuntimeLibrary::open(const std::string& path, std::string& reason) {
  const std::vector<std::string> candidates = candidates_for(path);
  void* library = nullptr;
  for (const std::string& candidate : candidates) {
    if (library == nullptr) library = dlopen(candidate.c_str(), RTLD_NOW | RTLD_LOCAL);
  }
  if (library == nullptr) {
    reason = candidates.size() == 1
                 ? std::string(dlerror())
                 : "no libonnxruntime.so.1 found; `npm install --prefix build --ignore-scripts "
                   "onnxruntime-node` installs one";
    return nullptr;
  }
  void* const get_base = dlsym(library, "OrtGetApiBase");
  if (get_base == nullptr) {
    reason = "OrtGetApiBase is not in the library: " + std::string(dlerror());
    return nullptr;
  }
  std::unique_ptr<OnnxRuntimeLibrary> result(
      new OnnxRuntimeLibrary(reinterpret_cast<const void* (*)()>(get_base)()));
  if (result->table_ != nullptr) return result;
  reason = "ONNX Runtime " + result->version() + " is too old: version 1.11 or later is needed";
  return nullptr;
}

OnnxRuntimeLibrary::OnnxRuntimeLibrary(const void* base)
    : base_(base), table_(static_cast<const Base*>(base)->table(kTableVersion)) {}

std::string OnnxRuntimeLibrary::version() const {
  return static_cast<const Base*>(base_)->version_string();
}

template <class Function>
Function* OnnxRuntimeLibrary::function(int place) const {
  return reinterpret_cast<Function*>(const_cast<void*>(table_[place]));
}

void OnnxRuntimeLibrary::require(Object* status) const {
  if (status == nullptr) return;
  const std::string message = function<const char*(const Object*)>(kGetErrorMessage)(status);
  function<void(Object*)>(kReleaseStatus)(status);
  throw std::runtime_error("ONNX Runtime: " + message);
}

template <int kMake, int kRelease, class... Arguments>
OnnxRuntimeLibrary::Handle OnnxRuntimeLibrary::made(Arguments... arguments) const {
  Object* object = nullptr;
  require(function<Object*(Arguments..., Object**)>(kMake)(arguments..., &object));
  return {object, function<void(Object*)>(kRelease)};
}

OnnxRuntimeLibrary::Handle OnnxRuntimeLibrary::make_environment() const {
  return made<kCreateEnv, kReleaseEnv>(kErrorsOnly, "tumblesight");
}

OnnxRuntimeLibrary::Handle OnnxRuntimeLibrary::make_session(const Handle& environment,
                                                            const std::string& onnx_model) const {
  using Set = Object*(Object*, int);
  const Handle options = made<kCreateSessionOptions, kReleaseSessionOptions>();
  require(function<Set>(kSetSessionExecutionMode)(options.get(), kSequential));
  require(function<Set>(kSetSessionGraphOptimizationLevel)(options.get(), kAllOptimizations));
  require(function<Set>(kSetIntraOpNumThreads)(options.get(), 1));
  require(function<Set>(kSetInterOpNumThreads)(options.get(), 1));
  return made<kCreateSessionFromArray, kReleaseSession>(
      static_cast<const Object*>(environment.get()), static_cast<const void*>(onnx_model.data()),
      onnx_model.size(), static_cast<const Object*>(options.get()));
}

OnnxRuntimeLibrary::Handle OnnxRuntimeLibrary::make_tensor(float* numbers, std::size_t count,
                                                           const std::vector<std::int64_t>& shape) const {
  return make_tensor(numbers, count * sizeof(float), kFloat, shape);
}

OnnxRuntimeLibrary::Handle OnnxRuntimeLibrary::make_tensor(std::uint8_t* numbers, std::size_t count,
                                                           const std::vector<std::int64_t>& shape) const {
  return make_tensor(numbers, count, kUint8, shape);
}

OnnxRuntimeLibrary::Handle OnnxRuntimeLibrary::make_tensor(void* numbers, std::size_t bytes, int type,
                                                           const std::vector<std::int64_t>& shape) const {
  const Handle memory = made<kCreateCpuMemoryInfo, kReleaseMemoryInfo>(kDeviceAllocator, kDefaultMemory);
  return made<kCreateTensorWithData, kReleaseValue>(static_cast<const Object*>(memory.get()), numbers, bytes,
                                                    shape.data(), shape.size(), type);
}

void OnnxRuntimeLibrary::run(const Handle& session, const std::vector<const char*>& input_names,
                             const std::vector<Object*>& inputs, const std::vector<const char*>& output_names,
                             std::vector<Object*>& outputs) const {
  using Run = Object*(Object*, const Object*, const char* const*, const Object* const*, std::size_t,
                      const char* const*, std::size_t, Object**);
  require(function<Run>(kRun)(session.get(), nullptr, input_names.data(), inputs.data(), inputs.size(),
                              output_names.data(), outputs.size(), outputs.data()));
}

}  // namespace tumblesight::sim
