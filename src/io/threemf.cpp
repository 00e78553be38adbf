// SPDX-License-Identifier: Apache-2.0
//
// 3MF: the objects of the build, with their components, in their places. Every mesh in its place is
// a part. Coordinates are the nearest doubles to the file's text, in the unit of its root model.
// Source: 3MF Consortium, "3D Manufacturing Format, Core Specification" and "Production Extension".
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "io/bad_file.h"
#include "io/mesh_formats.h"
#include "io/mesh_parts.h"
#include "io/placement.h"
#include "io/threemf_model.h"
#include "io/xml_reader.h"
#include "io/zip_archive.h"
#include "support/count_words.h"

namespace pierce::io {
namespace {

constexpr std::string_view kRelationship = "/3dmodel";

std::string without_slash(std::string_view path) {
  while (path.starts_with('/')) path.remove_prefix(1);
  return std::string(path);
}

class ThreemfReader {
 public:
  ThreemfReader(std::string_view bytes, const std::string& name)
      : archive_(bytes, name), name_(name) {}

  Mesh read() {
    const std::string root = root_path();
    const ThreemfModel& model = model_at(root);
    unit_ = model.unit;
    Below all;
    for (const ThreemfComponent& item : model.items) {
      add(count(root, item, 0), all);
      if (all.places > kMostPlaces) fail(item, "the build places more than 1,048,576 objects");
    }
    if (all.vertices > kMaxVertices) bad_file(name_, "more than 2^32 - 1 vertices: split it");
    for (const ThreemfComponent& item : model.items) place(root, item, {});
    if (model.items.empty()) {
      mesh_.warnings.push_back(fmt::format("its build is empty: it places none of its {}",
                                           counted(model.objects.size(), "object", "objects")));
    }
    if (aids_ > 0) {
      mesh_.warnings.push_back(
          fmt::format("{} of type 'support' or 'other' (supports, modifiers) read like the others; "
                      "with --parts they are geometries of their own",
                      counted(aids_, "object", "objects")));
    }
    mesh_.format = fmt::format("3MF, unit {}", unit_name(unit_));
    return std::move(mesh_);
  }

 private:
  std::string root_path() {
    std::string root;
    const std::string file = "_rels/.rels";
    if (archive_.has(file)) {
      const XmlCalls calls = {
          [&](const XmlElement& element) {
            const auto type = element.attribute("Type"), target = element.attribute("Target");
            if (root.empty() && type && target && type->ends_with(kRelationship)) {
              root = without_slash(*target);
            }
          },
          [](XmlName) {}, [](std::string_view, std::string_view) {}};
      read_xml(archive_.read(file), name_ + ": " + file, calls);
    }
    if (root.empty()) root = "3D/3dmodel.model";
    if (!archive_.has(root)) bad_file(name_, "is a ZIP archive without a 3D model: it is no 3MF");
    return root;
  }

  const ThreemfModel& model_at(const std::string& path) {
    const auto known = models_.find(path);
    if (known != models_.end()) return known->second;
    return models_[path] = parse_threemf_model(archive_.read(path), name_ + ": " + path);
  }

  // What an object is with its components: a small file may place an object 2^24 times.
  struct Below {
    std::uint64_t places = 0, vertices = 0;
    int depth = 0;
    bool done = false;
  };
  static constexpr std::uint64_t kMostPlaces = std::uint64_t{1} << 20;

  // Sums that are too large stay so.
  static void add(const Below& one, Below& all) {
    constexpr std::uint64_t kMany = std::uint64_t{1} << 62;
    all.places = std::min(kMany, all.places + one.places);
    all.vertices = std::min(kMany, all.vertices + one.vertices);
    all.depth = std::max(all.depth, one.depth + 1);
  }

  const ThreemfObject& object_of(const std::string& where, const ThreemfComponent& item) {
    if (!archive_.has(where)) fail(item, fmt::format("there is no part {}", in_quotes(where)));
    const ThreemfModel& model = model_at(where);
    const auto found = model.objects.find(item.object);
    if (found == model.objects.end()) {
      fail(item, fmt::format("there is no object {}", in_quotes(item.object)));
    }
    return found->second;
  }

  // Each object once, as deep as an honest file goes, and no deeper.
  const Below& count(const std::string& path, const ThreemfComponent& item, int depth) {
    constexpr int kDeepest = 100;
    const std::string& where = item.path.empty() ? path : item.path;
    const ThreemfObject& object = object_of(where, item);
    const auto [at, is_new] = below_.try_emplace(&object);
    Below& below = at->second;
    if (!is_new && !below.done) fail(item, "its components go round in a circle");
    if (is_new) {
      if (depth > kDeepest) fail(item, "its components lie more than 100 deep");
      below = {1, object.vertices.size(), 0, false};
      for (const ThreemfComponent& component : object.components) {
        add(count(where, component, depth + 1), below);
      }
      below.done = true;
    }
    if (depth + below.depth > kDeepest) fail(item, "its components lie more than 100 deep");
    return below;
  }

  void place(const std::string& path, const ThreemfComponent& item, const Matrix& outer) {
    const std::string& where = item.path.empty() ? path : item.path;
    const ThreemfObject& object = object_of(where, item);
    const Matrix matrix = product(outer, item.matrix);
    if (!is_finite(matrix)) fail(item, "its transform is too large for doubles");
    for (const ThreemfComponent& component : object.components) place(where, component, matrix);
    if (!object.triangles.empty()) append(object, in_root_unit(matrix, model_at(where).unit));
  }

  [[noreturn]] void fail(const ThreemfComponent& item, const std::string& message) const {
    bad_file(name_, fmt::format("object {}: {}: correct it", in_quotes(item.object), message));
  }

  // A part may be in another unit than the root, whose the transforms are.
  [[nodiscard]] Matrix in_root_unit(const Matrix& matrix, ThreemfUnit unit) const {
    if (unit == unit_) return matrix;
    const double factor = millimetres(unit) / millimetres(unit_);
    return product(matrix, {{{{factor, 0, 0, 0}, {0, factor, 0, 0}, {0, 0, factor, 0}}}});
  }

  void append(const ThreemfObject& object, const Matrix& matrix) {
    const std::size_t base = mesh_.vertices.size();
    mesh_.part_runs.push_back(
        {static_cast<std::uint32_t>(mesh_.part_names.size()), mesh_.triangles.size()});
    mesh_.part_names.push_back(object.name);
    if (object.is_aid) ++aids_;
    const bool moved = matrix != Matrix{}, mirrored = mirrors(matrix);
    for (const Vec3<double>& p : object.vertices) {
      mesh_.vertices.push_back(moved ? placed(matrix, p) : p);
    }
    for (Triangle t : object.triangles) {
      if (mirrored) std::swap(t[1], t[2]);  // so that its outside stays outside
      for (std::uint32_t& corner : t) corner += static_cast<std::uint32_t>(base);
      mesh_.triangles.push_back(t);
    }
  }

  ZipArchive archive_;
  const std::string& name_;
  std::map<std::string, ThreemfModel> models_;
  ThreemfUnit unit_ = ThreemfUnit::Millimetre;
  std::map<const ThreemfObject*, Below> below_;
  std::uint64_t aids_ = 0;
  Mesh mesh_;
};

}  // namespace

Mesh read_threemf(std::string_view bytes, const std::string& name) {
  return ThreemfReader(bytes, name).read();
}

}  // namespace pierce::io
