// ONNX Runtime's C interface, as far as a session on one thread needs it, from a shared library found at run
// time. npm ships that without a header: the table of functions only ever grows at its end, so a
// function keeps its place in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tumblesight::sim {

class OnnxRuntimeLibrary {
 public:
  // What its functions hand out and take back; of each kind nothing but the address is known.
  struct Object;
  using Release = void (*)(Object*);
  using Handle = std::unique_ptr<Object, Release>;

  // Of this path; empty: of $TUMBLESIGHT_ONNXRUNTIME, npm's onnxruntime-node in build/node_modules, or the
  // system. nullptr, and why in `reason`.
  static std::unique_ptr<OnnxRuntimeLibrary> open(const std::string& path, std::string& reason);

  std::string version() const;

  // Each throws std::runtime_error with ONNX Runtime's own words.
  Handle make_environment() const;
  // One thread, all optimizations, node after node.
  Handle make_session(const Handle& environment, const std::string& onnx_model) const;
  // Over the caller's numbers, which stay where they are.
  Handle make_tensor(float* numbers, std::size_t count, const std::vector<std::int64_t>& shape) const;
  void run(const Handle& session, const std::vector<const char*>& input_names,
           const std::vector<Object*>& inputs, const std::vector<const char*>& output_names,
           std::vector<Object*>& outputs) const;

 private:
  explicit OnnxRuntimeLibrary(const void* base);
  template <class Function>
  Function* function(int place) const;
  void require(Object* status) const;
  template <int kMake, int kRelease, class... Arguments>
  Handle made(Arguments... arguments) const;

  const void* base_;
  const void* const* table_ = nullptr;
};

}  // namespace tumblesight::sim
