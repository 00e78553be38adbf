// SPDX-License-Identifier: Apache-2.0
//
// Scene::save. Sections are written one after the other, the header, which names them all, last.
#include <algorithm>
#include <cstring>
#include <map>
#include <span>
#include <utility>

#include "scene/file/layout.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"
#include "support/checksum.h"
#include "support/new_file.h"
#include "support/parallel.h"

namespace pierce {
namespace {

using scene::GeometryRecord;
using scene::kSceneFilePage;
using scene::SceneFileHeader;
using scene::Section;

class SceneFileWriter {
 public:
  SceneFileWriter(const std::string& path, const WorkOptions& work, std::uint64_t all)
      : file_(path), work_(work), all_(all) {}

  Section add(std::span<const std::byte> bytes) {
    const Section section{end_, bytes.size(), checksum(bytes, poll, &work_)};
    constexpr std::size_t kPiece = std::size_t{1} << 26;
    for (std::size_t at = 0; at < bytes.size(); at += kPiece) {
      poll(&work_);
      const auto piece = bytes.subspan(at, std::min(kPiece, bytes.size() - at));
      file_.write(end_ + at, piece);
      written_ += piece.size();
      if (work_.progress && written_ < all_)
        work_.progress(static_cast<double>(written_) / static_cast<double>(all_));
    }
    const std::uint64_t end = end_ + bytes.size();
    end_ = (end + kSceneFilePage - 1) / kSceneFilePage * kSceneFilePage;
    return section;
  }
  /// The same for an array, unless it was added before.
  template <class T>
  Section add_once(std::span<const T> array) {
    const auto known = arrays_.try_emplace({array.data(), array.size_bytes()}, Section{});
    if (known.second) known.first->second = add(std::as_bytes(array));
    return known.first->second;
  }

  void finish(SceneFileHeader& header) {
    // The last section is not followed by zeros unless they are written.
    constexpr std::byte kZero{};
    file_.write(end_ - 1, std::span(&kZero, 1));
    header.file_bytes = end_;
    const auto bytes = std::as_bytes(std::span(&std::as_const(header), 1));
    header.checksum = xxh64(bytes.first(offsetof(SceneFileHeader, checksum)));
    file_.write(0, bytes);
    file_.commit();
    if (work_.progress) work_.progress(1);
  }

 private:
  static void poll(const void* work) {
    scene::StopPoll(static_cast<const WorkOptions*>(work)->stop).now();
  }

  NewFile file_;
  const WorkOptions& work_;
  std::uint64_t all_, written_ = 0, end_ = kSceneFilePage;
  std::map<std::pair<const void*, std::size_t>, Section> arrays_;
};

std::vector<std::byte> names_of(std::span<const std::string> names, std::size_t geometries) {
  if (!names.empty() && names.size() != geometries) {
    throw Error(ErrorCode::SizeMismatch, std::to_string(names.size()) + " names for " +
                                             std::to_string(geometries) +
                                             " geometries; give none, or one a geometry");
  }
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i < geometries; ++i) {
    const std::string name = names.empty() ? std::string() : names[i].substr(0, 65535);
    const auto length = static_cast<std::uint32_t>(name.size());
    const auto head = std::as_bytes(std::span(&length, 1));
    const auto text = std::as_bytes(std::span(name));
    bytes.insert(bytes.end(), head.begin(), head.end());
    bytes.insert(bytes.end(), text.begin(), text.end());
  }
  return bytes;
}

}  // namespace

template <class Real>
void Scene<Real>::save(const std::string& path, const SaveOptions& options) const {
  const bvh::Tree& tree = impl_->tree;
  const scene::Geometries<Real>& geometries = impl_->geometries;
  if (geometries.shares_meshes()) {
    throw Error(
        ErrorCode::InvalidArgument,
        "a scene of instances that share their meshes' trees cannot be saved; build it with "
        "a larger flatten_limit");
  }
  const auto meshes = geometries.meshes();
  const std::vector<std::byte> names = names_of(options.names, meshes.size());
  std::uint64_t all = tree.bytes();
  for (const MeshView<Real>& mesh : meshes)
    all += mesh.vertices.size_bytes() + mesh.triangles.size_bytes();

  SceneFileHeader header{};
  std::copy(std::begin(scene::kSceneFileMagic), std::end(scene::kSceneFileMagic), header.magic);
  header.version = scene::kSceneFileVersion;
  header.real_bytes = sizeof(Real);
  header.geometries = meshes.size();
  header.triangles = geometries.size();
  header.quality = static_cast<std::uint32_t>(impl_->quality);
  header.layout = static_cast<std::uint32_t>(
      impl_->quality == Quality::Compact ? bvh::Layout::Compact : bvh::Layout::Full);
  header.has_masks = geometries.masks().empty() ? 0 : 1;
  const scene::Extent& extent = geometries.extent();
  header.all_floats = extent.floats ? 1 : 0;
  for (std::size_t k = 0; k < 3; ++k) {
    header.lower[k] = (&extent.lower.x)[k];
    header.upper[k] = (&extent.upper.x)[k];
    header.tree_lower[k] = tree.lower[k];
    header.tree_upper[k] = tree.upper[k];
  }
  header.smallest = extent.smallest;
  header.leaf_blocks = tree.leaf_blocks;
  header.sah_cost = tree.sah_cost;
  header.built_cost = impl_->built_cost;
  header.root = tree.root;

  parallel::with_threads(options.work.threads, [&] {
    SceneFileWriter writer(path, options.work, all);
    header.nodes = writer.add(std::as_bytes(std::span(tree.nodes.data(), tree.nodes.size())));
    header.leaves = writer.add(std::span(tree.leaves.data(), tree.leaves.size()));
    std::vector<GeometryRecord> table;
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      table.push_back({writer.add_once(meshes[i].vertices), writer.add_once(meshes[i].triangles),
                       geometries.masks().empty() ? kAllBits : geometries.masks()[i], 0});
    }
    header.table = writer.add(std::as_bytes(std::span<const GeometryRecord>(table)));
    header.names = writer.add(names);
    writer.finish(header);
  });
}

template void Scene<float>::save(const std::string&, const SaveOptions&) const;
template void Scene<double>::save(const std::string&, const SaveOptions&) const;

}  // namespace pierce
