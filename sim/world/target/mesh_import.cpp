#include "sim/world/target/mesh_import.hpp"

#include <stdexcept>

#ifdef TUMBLESIGHT_HAS_ASSIMP
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Core>
#include <assimp/Importer.hpp>
#include <cstdint>

#include "sim/world/target/gltf_surface.hpp"
#include "sim/world/target/mesh_axes.hpp"
#include "sim/world/target/mesh_builder.hpp"
#endif

namespace tumblesight::sim {

#ifdef TUMBLESIGHT_HAS_ASSIMP

namespace {

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
  } catch (const std::exception&) {  // for instance out of memory
    scene = nullptr;
  }
  // Assimp's own words name its sources, and can be as long as the file.
  if (scene == nullptr || (scene->mFlags & AI_SCENE_FLAGS_INCOMPLETE) != 0U)
    throw std::runtime_error("cannot be read: its parts cannot be put together; export it again");
  TriangleMesh mesh;
  mesh.name = path;
  bool named = false;  // a part is named as a panel
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    if ((scene->mMeshes[i]->mPrimitiveTypes & aiPrimitiveType_TRIANGLE) != 0U) {
      append_faces(*scene->mMeshes[i], options, mesh);
      const bool panel =
          names_a_panel(scene->mMaterials[scene->mMeshes[i]->mMaterialIndex]->GetName().C_Str());
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
      "this build has no Assimp and reads no glTF; install libassimp-dev, configure and build again, or "
      "export "
      "the mesh as STL, OBJ or PLY");
}

#endif

}  // namespace tumblesight::sim
