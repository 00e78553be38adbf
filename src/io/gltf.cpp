// SPDX-License-Identifier: Apache-2.0
//
// glTF 2.0: the triangles of the scene's nodes, each node a part. Positions are the file's numbers,
// exactly; a node's matrix is the product of those above it in double, every entry rounded once,
// and a vertex under it is the exact image, rounded once, as Instance has it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "io/bad_file.h"
#include "io/gltf_primitive.h"
#include "io/mesh_formats.h"
#include "io/mesh_parts.h"
#include "io/placement.h"
#include "support/count_words.h"

namespace pierce::io {
namespace {

// Normals go by the cofactors, which need no division; only their direction matters. Where the
// matrix mirrors, that is the opposite.
Vec3<float> turned_normal(const Matrix& matrix, const Vec3<float>& n) {
  const double sign = mirrors(matrix) ? -1 : 1;
  const auto along = [&](std::size_t i) {
    const auto& a = matrix.rows[(i + 1) % 3];
    const auto& b = matrix.rows[(i + 2) % 3];
    return nearest_float(sign * (static_cast<double>(n.x) * (a[1] * b[2] - a[2] * b[1]) +
                                 static_cast<double>(n.y) * (a[2] * b[0] - a[0] * b[2]) +
                                 static_cast<double>(n.z) * (a[0] * b[1] - a[1] * b[0])));
  };
  return {along(0), along(1), along(2)};
}

// Scale, then the rotation of a quaternion, then translation.
Matrix from_parts(const std::array<double, 3>& t, const std::array<double, 4>& q,
                  const std::array<double, 3>& s) {
  const auto [x, y, z, w] = q;
  return {{{{{(1 - 2 * (y * y + z * z)) * s[0], 2 * (x * y - z * w) * s[1],
              2 * (x * z + y * w) * s[2], t[0]}},
            {{2 * (x * y + z * w) * s[0], (1 - 2 * (x * x + z * z)) * s[1],
              2 * (y * z - x * w) * s[2], t[1]}},
            {{2 * (x * z - y * w) * s[0], 2 * (y * z + x * w) * s[1],
              (1 - 2 * (x * x + y * y)) * s[2], t[2]}}}}};
}

template <std::size_t N>
std::array<double, N> read_array(const JsonView& node, const char* key,
                                 std::array<double, N> otherwise) {
  const std::optional<JsonView> found = node.find(key);
  if (!found) return otherwise;
  if (found->size() != N) found->fail(fmt::format("expected {} numbers: correct it", N));
  for (std::size_t i = 0; i < N; ++i) otherwise[i] = found->at(i).number();
  return otherwise;
}

Matrix local_matrix(const JsonView& node) {
  const bool parts = node.has("translation") || node.has("rotation") || node.has("scale");
  const std::optional<JsonView> matrix = node.find("matrix");
  if (!matrix) {
    return from_parts(read_array<3>(node, "translation", {}),
                      read_array<4>(node, "rotation", {0, 0, 0, 1}),
                      read_array<3>(node, "scale", {1, 1, 1}));
  }
  if (parts) matrix->fail("beside a translation, rotation or scale: remove one of the two");
  const std::array<double, 16> columns = read_array<16>(node, "matrix", {});
  if (columns[3] != 0 || columns[7] != 0 || columns[11] != 0 || columns[15] != 1) {
    matrix->fail("its last row is not 0 0 0 1: only affine transforms are read");
  }
  Matrix out;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 4; ++j) out.rows[i][j] = columns[4 * j + i];
  }
  return out;
}

class GltfReader {
 public:
  GltfReader(std::string_view bytes, const std::string& name) : file_(bytes, name) {}

  Mesh read() {
    struct Step {
      JsonView node;
      Matrix outer;
    };
    std::vector<Step> stack;
    const std::vector<JsonView> roots = find_roots();
    for (std::size_t i = roots.size(); i-- > 0;) stack.push_back({roots[i], {}});
    // Depth first, a node's own mesh before its children's.
    while (!stack.empty()) {
      const Step step = std::move(stack.back());
      stack.pop_back();
      warn_of_rotation(step.node);
      const Matrix matrix = product(step.outer, local_matrix(step.node));
      if (!is_finite(matrix)) step.node.fail("its transform is too large for doubles: scale it");
      read_node(step.node, matrix);
      const std::optional<JsonView> children = step.node.find("children");
      for (std::uint64_t i = children ? children->size() : 0; i-- > 0;) {
        stack.push_back({enter(children->at(i)), matrix});
      }
    }
    finish();
    return std::move(mesh_);
  }

 private:
  // The node that `index` names, which nothing has named before: so there are no loops.
  JsonView enter(const JsonView& index) {
    JsonView node = file_.document().named("nodes", index);
    const std::uint64_t number = index.whole();
    if (visited_.size() <= number) visited_.resize(number + 1);
    if (visited_[number]) {
      index.fail(fmt::format("node {} has more than one place: give each its own", number), number);
    }
    visited_[number] = true;
    return node;
  }

  std::vector<JsonView> find_roots() {
    const JsonView document = file_.document();
    std::vector<JsonView> roots;
    const std::optional<JsonView> scenes = document.find("scenes");
    if (scenes && scenes->size() > 0) {
      const std::optional<JsonView> chosen = document.find("scene");
      if (!chosen && scenes->size() > 1) {
        warn(
            fmt::format("none of its {} scenes is the default: the first is read", scenes->size()));
      }
      const JsonView scene =
          chosen ? document.named("scenes", *chosen) : scenes->at(std::uint64_t{0});
      const std::optional<JsonView> nodes = scene.find("nodes");
      for (std::uint64_t i = 0; nodes && i < nodes->size(); ++i) {
        roots.push_back(enter(nodes->at(i)));
      }
      return roots;
    }
    if (const std::optional<JsonView> chosen = document.find("scene")) {
      (void)document.named("scenes", *chosen);
    }
    return roots_without_scene(document);
  }

  // All nodes that are nobody's children; without nodes, every mesh as it is.
  std::vector<JsonView> roots_without_scene(const JsonView& document) {
    std::vector<JsonView> roots;
    const std::optional<JsonView> nodes = document.find("nodes");
    const std::uint64_t count = nodes ? nodes->size() : 0;
    std::vector<bool> child(count);
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::optional<JsonView> children = nodes->at(i).find("children");
      for (std::uint64_t k = 0; children && k < children->size(); ++k) {
        (void)document.named("nodes", children->at(k));
        child[children->at(k).whole()] = true;
      }
    }
    visited_.resize(count);
    for (std::uint64_t i = 0; i < count; ++i) {
      if (child[i]) continue;
      visited_[i] = true;
      roots.push_back(nodes->at(i));
    }
    const std::optional<JsonView> meshes = document.find("meshes");
    if (count == 0 && meshes) {
      warn("has no nodes: each mesh is read once, as it is");
      for (std::uint64_t i = 0; i < meshes->size(); ++i) {
        begin_part(meshes->at(i));
        place(read_primitives(meshes->at(i)), {});
      }
    }
    return roots;
  }

  void read_node(const JsonView& node, const Matrix& matrix) {
    const std::optional<JsonView> index = node.find("mesh");
    if (!index) return;
    const JsonView mesh = file_.document().named("meshes", *index);
    if (has_morph(node)) {
      warn(fmt::format("{}: its morph targets are not applied", node.where()));
    }
    if (node.has("skin")) {
      warn(
          fmt::format("{}: its skin is not applied, the mesh is read as it is under the node's "
                      "transform",
                      node.where()));
    }
    begin_part(node);
    const std::vector<GltfPrimitive> primitives = read_primitives(mesh);
    const std::optional<JsonView> extensions = node.find("extensions");
    if (!extensions || !extensions->has("EXT_mesh_gpu_instancing")) {
      place(primitives, matrix);
      return;
    }
    for (const Matrix& instance : read_instances(extensions->at("EXT_mesh_gpu_instancing"))) {
      place(primitives, product(matrix, instance));
    }
  }

  std::vector<Matrix> read_instances(const JsonView& extension) {
    const JsonView attributes = extension.at("attributes");
    std::optional<std::uint64_t> count;
    const auto column = [&](const char* key, unsigned components) {
      const std::optional<JsonView> found = attributes.find(key);
      if (!found) return GltfNumbers{};
      GltfNumbers numbers = file_.numbers(*found, components);
      if (count && *count != numbers.count) {
        attributes.fail("its attributes are not of one length: correct it");
      }
      count = numbers.count;
      return numbers;
    };
    const GltfNumbers t = column("TRANSLATION", 3), q = column("ROTATION", 4),
                      s = column("SCALE", 3);
    std::vector<Matrix> instances;
    for (std::uint64_t i = 0; i < count.value_or(0); ++i) {
      const auto take = [i]<std::size_t N>(const GltfNumbers& numbers, std::array<double, N> all) {
        for (std::size_t k = 0; k < N && numbers.count > 0; ++k)
          all[k] = numbers.numbers[N * i + k];
        return all;
      };
      instances.push_back(from_parts(take(t, std::array<double, 3>{}),
                                     take(q, std::array<double, 4>{0, 0, 0, 1}),
                                     take(s, std::array<double, 3>{1, 1, 1})));
      if (!is_finite(instances.back())) {
        attributes.fail(fmt::format("the transform of instance {} is not finite: correct it", i),
                        i);
      }
    }
    return instances;
  }

  // A rotation is a quaternion of length 1; another shears and scales.
  void warn_of_rotation(const JsonView& node) {
    const auto [x, y, z, w] = read_array<4>(node, "rotation", {0, 0, 0, 1});
    constexpr double kRounding = 1e-2;
    if (std::abs(x * x + y * y + z * z + w * w - 1) <= kRounding) return;
    warn(fmt::format("{}: its rotation is no unit quaternion: taken as it is", node.where()));
  }

  // Every node with a mesh is a part, whatever its name.
  void begin_part(const JsonView& named) {
    mesh_.part_runs.push_back(
        {static_cast<std::uint32_t>(mesh_.part_names.size()), mesh_.triangles.size()});
    mesh_.part_names.push_back(
        named.has("name") && named.at("name").json().is_string() ? named.at("name").text() : "");
  }

  std::vector<GltfPrimitive> read_primitives(const JsonView& mesh) {
    const JsonView list = mesh.at("primitives");
    std::vector<GltfPrimitive> primitives;
    for (std::uint64_t i = 0; i < list.size(); ++i) {
      std::optional<GltfPrimitive> primitive = read_gltf_primitive(file_, list.at(i));
      if (primitive) primitives.push_back(*std::move(primitive));
      if (!primitive) ++left_out_;
    }
    if (list.size() > 0 && has_morph(mesh)) {
      warn(fmt::format("{}: its morph targets are not applied", mesh.where()));
    }
    return primitives;
  }

  [[nodiscard]] static bool has_morph(const JsonView& mesh) {
    const std::optional<JsonView> weights = mesh.find("weights");
    for (std::uint64_t i = 0; weights && i < weights->size(); ++i) {
      if (weights->at(i).number() != 0) return true;
    }
    return false;
  }

  void place(const std::vector<GltfPrimitive>& primitives, const Matrix& matrix) {
    if (!is_finite(matrix))
      bad_file(file_.name(), "a transform is too large for doubles: scale it");
    const bool mirrored = mirrors(matrix);
    for (const GltfPrimitive& primitive : primitives) append(primitive, matrix, mirrored);
  }

  void append(const GltfPrimitive& part, const Matrix& matrix, bool mirrored) {
    const std::size_t base = mesh_.vertices.size();
    if (base + part.positions.count > kMaxVertices) {
      bad_file(file_.name(), "more than 2^32 - 1 vertices: split it");
    }
    const std::vector<double>& numbers = part.positions.numbers;
    const bool moved = matrix != Matrix{};
    all_single_ = all_single_ && (part.positions.floats || part.positions.count == 0);
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3) {
      const Vec3<double> p = {numbers[i], numbers[i + 1], numbers[i + 2]};
      mesh_.vertices.push_back(moved ? placed(matrix, p) : p);
    }
    append_attributes(part, matrix, base);
    for (Triangle t : part.triangles) {
      // A mirrored part is turned inside out; swapping two corners turns it back.
      if (mirrored) std::swap(t[1], t[2]);
      for (std::uint32_t& corner : t) corner += static_cast<std::uint32_t>(base);
      mesh_.triangles.push_back(t);
    }
  }

  // Parts that lack what others have get neutral values.
  void append_attributes(const GltfPrimitive& part, const Matrix& matrix, std::size_t base) {
    if (!part.normals.empty()) {
      mesh_.normals.resize(base);
      for (const Vec3<float>& n : part.normals) {
        mesh_.normals.push_back(turned_normal(matrix, n));
      }
    }
    if (!part.colors.empty()) {
      mesh_.colors.resize(base, {1, 1, 1});
      mesh_.colors.insert(mesh_.colors.end(), part.colors.begin(), part.colors.end());
    }
    if (!part.texcoords.empty()) {
      mesh_.texcoords.resize(base);
      mesh_.texcoords.insert(mesh_.texcoords.end(), part.texcoords.begin(), part.texcoords.end());
    }
  }

  void finish() {
    const std::size_t count = mesh_.vertices.size();
    mesh_.normals.resize(mesh_.normals.empty() ? 0 : count);
    mesh_.colors.resize(mesh_.colors.empty() ? 0 : count, {1, 1, 1});
    mesh_.texcoords.resize(mesh_.texcoords.empty() ? 0 : count);
    mesh_.single_precision = all_single_ && all_floats(mesh_.vertices);
    mesh_.format = file_.binary() ? "glTF, binary" : "glTF";
    if (mesh_.triangles.empty()) warn_of_nothing();
    mesh_.warnings = std::move(file_.warnings);
  }

  void warn_of_nothing() {
    const std::optional<JsonView> meshes = file_.document().find("meshes");
    if (mesh_.part_runs.empty() && meshes && meshes->size() > 0) {
      warn(fmt::format("its scene shows none of its {}: put nodes with them into the scene",
                       counted(meshes->size(), "mesh", "meshes")));
    }
    if (left_out_ > 0) {
      warn(fmt::format("{} of points or lines left out",
                       counted(left_out_, "primitive", "primitives")));
    }
  }

  void warn(std::string line) { file_.warnings.push_back(std::move(line)); }

  GltfFile file_;
  Mesh mesh_;
  std::vector<bool> visited_;
  std::uint64_t left_out_ = 0;  // primitives
  bool all_single_ = true;
};

}  // namespace

bool looks_like_glb(std::string_view bytes) { return bytes.starts_with("glTF"); }

Mesh read_gltf(std::string_view bytes, const std::string& name) {
  return GltfReader(bytes, name).read();
}

}  // namespace pierce::io
