// The part of ONNX Runtime's C interface that a session on one thread needs, from a shared library loaded at
// run time. npm ships the library without a header. Its table of functions only grows at the end, so that
// each function keeps its index.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tumblesight::sim {

class OnnxRuntimeLibrary {
 public:
  // Opaque objects of the library.
  struct Object;
  using Release = void (*)(Object*);
  using Handle = std::unique_ptr<Object, Release>;

  // `path` empty: $TUMBLESIGHT_ONNXRUNTIME, else npm's onnxruntime-node in build/node_modules, else the
  // system's library. Returns nullptr and sets `reason` if there is none.
  static std::unique_ptr<OnnxRuntimeLibrary> open(const std::string& path, std::string& reason);

  std::string version() const;

  // Each throws std::runtime_error with ONNX Runtime's message.
  Handle make_environment() const;
  // One thread, all optimizations, sequential execution. `onnx_model`: contents of an .onnx file.
  Handle make_session(const Handle& environment, const std::string& onnx_model) const;
  // A tensor over the caller's memory, which must outlive it.
  Handle make_tensor(float* numbers, std::size_t count, const std::vector<std::int64_t>& shape) const;
  Handle make_tensor(std::uint8_t* numbers, std::size_t count, const std::vector<std::int64_t>& shape) const;
  void run(const Handle& session, const std::vector<const char*>& input_names,
           const std::vector<Object*>& inputs, const std::vector<const char*>& output_names,
           std::vector<Object*>& outputs) const;

 private:
  explicit OnnxRuntimeLibrary(const void* base);
  template <class Function>
  Function* function(int place) const;
  void require(Object* status) const;
  Handle make_tensor(void* numbers, std::size_t bytes, int type,
                     const std::vector<std::int64_t>& shape) const;
  template <int kMake, int kRelease, class... Arguments>
  Handle made(Arguments... arguments) const;

  const void* base_;
  const void* const* table_ = nullptr;
};

}  // namespace tumblesight::sim
