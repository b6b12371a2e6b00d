// The numbers of a glTF file: buffers, their views, and the accessors that read them, sparse ones included.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/world/target/gltf_file.hpp"

namespace tumblesight::sim::gltf {

// Component types of accessors.
inline constexpr std::uint64_t kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
                               kUnsignedInt = 5125, kFloat = 5126;

// Of primitives: the mode that stands if none is given.
inline constexpr std::uint64_t kTriangles = 4;
inline constexpr std::uint64_t kTriangleFan = 6;

// Numbers of one element: 3 of "VEC3"; 0 if the type is unknown.
std::size_t components_of(const json& type);
// Bytes of one number; 0 if the type is unknown.
std::size_t bytes_of(std::uint64_t component_type);

struct Bytes {
  const char* data = nullptr;
  std::size_t size = 0;
};

// Every function throws std::runtime_error that says what is wrong, without the name of the file. `where`
// says which accessor is meant. The file must live as long as this.
class Data {
 public:
  explicit Data(const File& file);

  // All numbers of all elements, tightly packed. Whole numbers that stand for fractions are left as they are.
  std::vector<float> floats(std::size_t accessor, const std::string& where) const;
  std::vector<std::uint32_t> wholes(std::size_t accessor, const std::string& where) const;
  // The bytes of a buffer view.
  Bytes view(const json& number, const std::string& where) const;

 private:
  const File& file_;
  std::vector<std::string> buffers_;  // empty for the binary data of a GLB file
  std::vector<Bytes> bytes_;          // of each buffer
};

}  // namespace tumblesight::sim::gltf
