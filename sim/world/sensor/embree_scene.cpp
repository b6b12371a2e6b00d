#include "sim/world/sensor/embree_scene.hpp"

#include <algorithm>
#include <stdexcept>

namespace tumblesight::sim {

EmbreeScene::EmbreeScene(const TriangleMesh& mesh) {
  try {
    build(mesh);
  } catch (...) {
    release();
    throw;
  }
}

EmbreeScene::~EmbreeScene() {
  release();
}

void EmbreeScene::release() {
  if (scene_ != nullptr) rtcReleaseScene(scene_);
  if (device_ != nullptr) rtcReleaseDevice(device_);
}

void EmbreeScene::build(const TriangleMesh& mesh) {
  device_ = rtcNewDevice("threads=1");
  if (device_ == nullptr) throw std::runtime_error("Embree could not be started");
  scene_ = rtcNewScene(device_);
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices_trf_m.size()));
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t),
                              mesh.triangles.size()));
  if (vertices == nullptr || indices == nullptr)
    throw std::runtime_error("Embree refused the mesh of " + mesh.name);
  for (const Eigen::Vector3f& v : mesh.vertices_trf_m) vertices = std::copy(v.data(), v.data() + 3, vertices);
  for (const auto& t : mesh.triangles) indices = std::copy(t.begin(), t.end(), indices);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
  if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) {
    throw std::runtime_error("Embree could not build the scene of " + mesh.name);
  }
}

}  // namespace tumblesight::sim
