#include "sim/world/target/mesh_import.hpp"

#include <stdexcept>

#ifdef TUMBLESIGHT_HAS_ASSIMP
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Core>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cstdint>

#include "sim/world/target/gltf_surface.hpp"
#endif

namespace tumblesight::sim {

#ifdef TUMBLESIGHT_HAS_ASSIMP

namespace {

// Rotation from the axes of the file to the TRF.
Eigen::Matrix3d axes_trf_file(MeshUp up) {
  if (up == MeshUp::kZ) {
    return Eigen::Matrix3d::Identity();
  }
  Eigen::Matrix3d axes;
  axes << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return axes;
}

// Whether the name of its material says so. The names of nodes are lost when their transforms are applied.
bool is_named_panel(const aiMaterial& material) {
  std::string name = material.GetName().C_Str();
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return name.find("panel") != std::string::npos || name.find("solar") != std::string::npos;
}

void append_faces(const aiMesh& part, const MeshFileOptions& options, TriangleMesh& mesh) {
  const Eigen::Matrix3d to_trf_m = options.scale * axes_trf_file(options.up);
  const auto offset = static_cast<std::uint32_t>(mesh.vertices_trf_m.size());
  for (unsigned i = 0; i < part.mNumVertices; ++i) {
    const aiVector3D& v = part.mVertices[i];
    mesh.vertices_trf_m.push_back(
        (to_trf_m * Eigen::Vector3d(v.x, v.y, v.z) - options.origin_trf_m).cast<float>());
  }
  for (unsigned i = 0; i < part.mNumFaces; ++i) {
    const aiFace& face = part.mFaces[i];
    if (face.mNumIndices == 3) {
      mesh.triangles.push_back(
          {offset + face.mIndices[0], offset + face.mIndices[1], offset + face.mIndices[2]});
    }
  }
}

}  // namespace

TriangleMesh import_mesh(const std::string& path, const MeshFileOptions& options) {
  Assimp::Importer importer;
  // Only the surface is needed. Points and lines are sorted into separate meshes and left out: no ray hits
  // them.
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                              aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS | aiComponent_COLORS |
                                  aiComponent_TEXCOORDS | aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                  aiComponent_TEXTURES | aiComponent_LIGHTS | aiComponent_CAMERAS);
  importer.SetPropertyBool(AI_CONFIG_PP_PTV_KEEP_HIERARCHY, false);
  const unsigned steps = aiProcess_Triangulate | aiProcess_RemoveComponent | aiProcess_PreTransformVertices |
                         aiProcess_SortByPType | aiProcess_ValidateDataStructure;
  const std::string surface = is_gltf_name(path) ? gltf_surface(path) : std::string();
  const aiScene* scene = nullptr;
  try {
    scene = surface.empty() ? importer.ReadFile(path, steps)
                            : importer.ReadFileFromMemory(surface.data(), surface.size(), steps, "glb");
  } catch (const std::exception& error) {  // for instance out of memory
    throw std::runtime_error(std::string("cannot be read: ") + error.what());
  }
  // Assimp's own words would be about the GLB file that it was given.
  if (!surface.empty() && scene == nullptr) {
    throw std::runtime_error("cannot be read: its parts cannot be put together; export it again");
  }
  if (scene == nullptr || (scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE) != 0U) {
    throw std::runtime_error(std::string("cannot be read as STL, OBJ, glTF or GLB: ") +
                             importer.GetErrorString() + "; export it again");
  }
  TriangleMesh mesh;
  mesh.name = path;
  bool named = false;  // a part is named as a panel
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    if ((scene->mMeshes[i]->mPrimitiveTypes & aiPrimitiveType_TRIANGLE) != 0U) {
      append_faces(*scene->mMeshes[i], options, mesh);
      const bool panel = is_named_panel(*scene->mMaterials[scene->mMeshes[i]->mMaterialIndex]);
      named = named || panel;
      mesh.is_panel.resize(mesh.triangles.size(), panel ? 1 : 0);
    }
  }
  if (!named) mesh.is_panel.clear();
  return mesh;
}

#else

TriangleMesh import_mesh(const std::string&, const MeshFileOptions&) {
  throw std::runtime_error(
      "this build has no Assimp and reads no mesh files; install libassimp-dev, configure and build again");
}

#endif

}  // namespace tumblesight::sim
