// Mesh files of any content: the result is a mesh that the sensor can render, or a message that names the
// file.
#include "sim/world/target/mesh_file.hpp"

#include <unistd.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "tests/fuzz/fuzz.hpp"

namespace tumblesight::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 5> kNames{"mesh.stl", "mesh.obj", "mesh.gltf", "mesh.glb", "mesh.ply"};
constexpr std::uint8_t kNameBits = 0x07;

// A folder in memory where there is such a file system; removed when the program ends.
class Folder {
 public:
  Folder() {
    const fs::path memory = "/dev/shm";
    path_ = (fs::is_directory(memory) ? memory : fs::temp_directory_path()) /
            ("fuzz_mesh_" + std::to_string(getpid()));
    fs::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  std::string write(const char* name, const Input& input) const {
    const fs::path path = path_ / name;
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(input.rest()), static_cast<std::streamsize>(input.left()));
    return path.string();
  }

 private:
  fs::path path_;
};

void check(const sim::TriangleMesh& mesh) {
  require(!mesh.triangles.empty(), "a mesh has triangles");
  for (const Eigen::Vector3f& vertex : mesh.vertices_trf_m) require(vertex.allFinite(), "a vertex is finite");
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      require(corner < mesh.vertices_trf_m.size(), "a triangle's corner is a vertex");
    }
  }
  const double radius = mesh.radius_m();
  require(radius >= sim::kMinMeshRadius_m && radius <= sim::kMaxMeshRadius_m, "a mesh fits the sensor");
}

}  // namespace
}  // namespace tumblesight::fuzz

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight;
  using namespace tumblesight::fuzz;
  static const Folder folder;
  Input input(data, size);
  const std::uint8_t choice = input.u8();
  const std::size_t name = (choice & kNameBits) % kNames.size();
  sim::MeshFileOptions options;
  options.up = (choice & 0x80) != 0 ? sim::MeshUp::kZ : sim::MeshUp::kY;
  options.scale = (choice & 0x40) != 0 ? 1e-3 : 1.0;
  const std::string path = folder.write(kNames[name], input);
  try {
    check(sim::load_mesh_file(path, options));
  } catch (const std::runtime_error& error) {
    require(std::string(error.what()).find(path) != std::string::npos, "a refusal names the file");
  }
  return 0;
}
