// SPDX-License-Identifier: Apache-2.0
//
// 3DS, DAE, FBX and whatever else Assimp reads. Assimp hands out floats (text formats
// have been rounded to float by it); the nodes' transforms are applied in double. Nothing is
// merged, split or optimised: no post-processing runs.
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <assimp/Importer.hpp>
#include <string_view>
#include <utility>
#include <vector>

#include "io/bad_file.h"
#include "io/mesh_formats.h"
#include "io/mesh_parts.h"
#include "io/polygons.h"
#include "io/text_cursor.h"

namespace pierce::io {
namespace {

// The upper three rows of an affine map.
struct Affine {
  double m[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

  [[nodiscard]] Vec3<double> point(const Vec3<double>& p) const {
    return {row(0, p) + m[0][3], row(1, p) + m[1][3], row(2, p) + m[2][3]};
  }
  [[nodiscard]] double row(int i, const Vec3<double>& p) const {
    return m[i][0] * p.x + m[i][1] * p.y + m[i][2] * p.z;
  }
  [[nodiscard]] double determinant() const {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  }
  // Normals go by the cofactors, which need no division; only their direction matters. Where the
  // matrix mirrors, that is the opposite.
  [[nodiscard]] Vec3<float> normal(const Vec3<double>& n) const {
    const double sign = determinant() < 0 ? -1 : 1;
    const auto cofactors = [&](int i) {
      const double* a = m[(i + 1) % 3];
      const double* b = m[(i + 2) % 3];
      return nearest_float(sign *
                           (n.x * (a[1] * b[2] - a[2] * b[1]) + n.y * (a[2] * b[0] - a[0] * b[2]) +
                            n.z * (a[0] * b[1] - a[1] * b[0])));
    };
    return {cofactors(0), cofactors(1), cofactors(2)};
  }
};

Affine product(const Affine& outer, const aiMatrix4x4& inner) {
  Affine out;
  for (int i = 0; i < 3; ++i) {
    for (unsigned j = 0; j < 4; ++j) {
      double sum = j == 3 ? outer.m[i][3] : 0.0;
      for (unsigned k = 0; k < 3; ++k) sum += outer.m[i][k] * static_cast<double>(inner[k][j]);
      out.m[i][j] = sum;
    }
  }
  return out;
}

Vec3<double> to_double(const aiVector3D& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

class Flattener {
 public:
  Flattener(const aiScene& scene, const std::string& name) : scene_(scene), name_(name) {}

  // Depth first, a node's own meshes before its children's.
  Mesh flatten() {
    struct Step {
      const aiNode* node;
      Affine outer;
    };
    std::vector<Step> stack = {{scene_.mRootNode, {}}};
    while (!stack.empty()) {
      const Step step = stack.back();
      stack.pop_back();
      const Affine transform = product(step.outer, step.node->mTransformation);
      begin_part(*step.node);
      for (unsigned i = 0; i < step.node->mNumMeshes; ++i) {
        const unsigned index = step.node->mMeshes[i];
        if (index < scene_.mNumMeshes && scene_.mMeshes[index] != nullptr) {
          append(*scene_.mMeshes[index], transform);
        }
      }
      for (unsigned i = step.node->mNumChildren; i-- > 0;) {
        // Some importers (RAW) leave gaps.
        const aiNode* const child = step.node->mChildren[i];
        if (child != nullptr) stack.push_back({child, transform});
      }
    }
    mesh_.normals.resize(mesh_.normals.empty() ? 0 : mesh_.vertices.size());
    mesh_.colors.resize(mesh_.colors.empty() ? 0 : mesh_.vertices.size(), {1, 1, 1});
    mesh_.texcoords.resize(mesh_.texcoords.empty() ? 0 : mesh_.vertices.size());
    polygons_.finish(mesh_);
    return std::move(mesh_);
  }

 private:
  // Every node is a part, whatever its name.
  void begin_part(const aiNode& node) {
    if (node.mNumMeshes == 0) return;
    mesh_.part_runs.push_back(
        {static_cast<std::uint32_t>(mesh_.part_names.size()), mesh_.triangles.size()});
    mesh_.part_names.emplace_back(node.mName.C_Str());
  }

  void append(const aiMesh& part, const Affine& transform) {
    if (!part.HasPositions() || !part.HasFaces()) return;
    const std::size_t base = mesh_.vertices.size();
    if (base + part.mNumVertices > kMaxVertices) bad_file(name_, "more than 2^32 - 1 vertices");
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      mesh_.vertices.push_back(transform.point(to_double(part.mVertices[i])));
    }
    append_attributes(part, transform, base);
    // A mirrored part is turned inside out; swapping two corners turns it back.
    const bool mirrored = transform.determinant() < 0;
    std::vector<std::uint32_t> corners;
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      corners.clear();
      for (unsigned k = 0; k < face.mNumIndices; ++k) {
        const unsigned index = face.mIndices[k];
        if (index >= part.mNumVertices) {
          bad_file(name_,
                   fmt::format("face {} of mesh '{}' names vertex {}, {}: correct "
                               "the file",
                               f, part.mName.C_Str(), index, there_are(part.mNumVertices)),
                   f);
        }
        corners.push_back(static_cast<std::uint32_t>(base + index));
      }
      const std::size_t first = mesh_.triangles.size();
      polygons_.append(corners, mesh_.triangles);
      for (std::size_t t = first; mirrored && t < mesh_.triangles.size(); ++t) {
        std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]);
      }
    }
  }

  // Parts that lack what others have get neutral values.
  void append_attributes(const aiMesh& part, const Affine& transform, std::size_t base) {
    if (part.HasNormals()) {
      mesh_.normals.resize(base);
      for (unsigned i = 0; i < part.mNumVertices; ++i) {
        mesh_.normals.push_back(transform.normal(to_double(part.mNormals[i])));
      }
    }
    if (part.HasVertexColors(0)) {
      mesh_.colors.resize(base, {1, 1, 1});
      for (unsigned i = 0; i < part.mNumVertices; ++i) {
        const aiColor4D& c = part.mColors[0][i];
        mesh_.colors.push_back({c.r, c.g, c.b});
      }
    }
    if (part.HasTextureCoords(0)) {
      mesh_.texcoords.resize(base);
      for (unsigned i = 0; i < part.mNumVertices; ++i) {
        const aiVector3D& t = part.mTextureCoords[0][i];
        mesh_.texcoords.push_back({t.x, t.y});
      }
    }
  }

  const aiScene& scene_;
  const std::string& name_;
  Mesh mesh_;
  Polygons polygons_;
};

// The format whose positions are 32-bit floats. (Of others Assimp makes floats, which is a loss.)
bool holds_floats(std::string_view extension) { return same_word(extension, "3ds"); }

Mesh to_mesh(const Assimp::Importer& importer, const aiScene* scene,
             const std::filesystem::path& path) {
  const std::string name = path.string();
  if (scene == nullptr || scene->mRootNode == nullptr) {
    bad_file(name, fmt::format("is no mesh file that can be read ({}): convert it to PLY, OBJ or "
                               "glTF",
                               in_quotes(importer.GetErrorString(), 300)));
  }
  Mesh mesh = Flattener(*scene, name).flatten();
  std::string extension = path.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  mesh.single_precision = holds_floats(extension) && all_floats(mesh.vertices);
  mesh.format = extension + ", by Assimp";
  // COLLADA's unit and upward axis are the root's transform.
  if (same_word(extension, "dae") && !scene->mRootNode->mTransformation.IsIdentity())
    mesh.format += ", brought to metres with y up";
  return mesh;
}

}  // namespace

Mesh read_by_assimp(const std::filesystem::path& path) {
  Assimp::Importer importer;
  return to_mesh(importer, importer.ReadFile(path.string(), 0), path);
}

Mesh read_by_assimp(const std::filesystem::path& path, std::string_view text) {
  Assimp::Importer importer;
  const std::string extension = path.extension().string();
  return to_mesh(importer,
                 importer.ReadFileFromMemory(text.data(), text.size(), 0, extension.c_str() + 1),
                 path);
}

bool assimp_reads(const std::string& extension) {
  return Assimp::Importer().IsExtensionSupported(extension);
}

}  // namespace pierce::io
