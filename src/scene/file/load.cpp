// SPDX-License-Identifier: Apache-2.0
//
// Scene::load: the file is mapped, and tree and meshes lie in the mapping. What queries follow
// blindly is looked at here, all of it: the header, the table, the structure of the tree. The rest
// they look at as they meet it (scene/geometries.h), or it is verified.
#include <span>
#include <utility>

#include "scene/file/check_tree.h"
#include "scene/file/layout.h"
#include "scene/scene_impl.h"
#include "scene/validate_input.h"
#include "support/checksum.h"
#include "support/float_environment.h"
#include "support/parallel.h"

namespace pierce {
namespace {

using scene::SceneFileHeader;
using scene::SceneFileTable;
using scene::Section;

template <class T>
bvh::HugeBuffer<T> in_place(const PrivateMapping& file, const Section& section) {
  if (section.bytes == 0) return {};
  return bvh::HugeBuffer<T>::over(reinterpret_cast<T*>(file.bytes().data() + section.offset),
                                  section.bytes / sizeof(T));
}

bvh::Tree tree_in(const PrivateMapping& file, const SceneFileHeader& header) {
  bvh::Tree tree;
  tree.layout = static_cast<bvh::Layout>(header.layout);
  tree.nodes = in_place<bvh::Node>(file, header.nodes);
  tree.leaves = in_place<std::byte>(file, header.leaves);
  tree.root = header.root;
  for (int k = 0; k < 3; ++k) {
    tree.lower[k] = header.tree_lower[k];
    tree.upper[k] = header.tree_upper[k];
  }
  tree.leaf_blocks = header.leaf_blocks;
  tree.sah_cost = header.sah_cost;
  return tree;
}

template <class T>
std::span<const T> array_in(const SceneFileTable& table, const Section& section) {
  const auto bytes = table.bytes(section);
  return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
}

void verify_checksums(const SceneFileTable& table, const WorkOptions& work) {
  std::vector<std::pair<Section, const char*>> sections = {{table.header.nodes, "the search tree"},
                                                           {table.header.leaves, "its leaves"}};
  for (const scene::GeometryRecord& geometry : table.geometries) {
    sections.emplace_back(geometry.vertices, "vertices");
    sections.emplace_back(geometry.triangles, "triangles");
  }
  const auto poll = [](const void* options) {
    scene::StopPoll(static_cast<const WorkOptions*>(options)->stop).now();
  };
  for (const auto& [section, what] : sections) {
    if (checksum(table.bytes(section), poll, &work) != section.checksum)
      table.damaged(std::string("the checksum of ") + what + " is another");
  }
}

}  // namespace

template <class Real>
Scene<Real> Scene<Real>::load(const std::string& path, const LoadOptions& options) {
  const FloatEnvironment environment;
  auto impl = std::make_unique<Impl>();
  impl->file = std::make_shared<const PrivateMapping>(path);
  const SceneFileTable table(impl->file->bytes(), path);
  const SceneFileHeader& header = table.header;
  if (header.real_bytes != sizeof(Real)) {
    throw Error(ErrorCode::BadFile, path + ": holds a scene of " +
                                        (header.real_bytes == 4 ? "floats: load it as Scene<float>"
                                                                : "doubles: load it as "
                                                                  "Scene<double>"));
  }
  std::vector<MeshView<Real>> meshes;
  std::vector<std::uint32_t> masks;
  for (const scene::GeometryRecord& geometry : table.geometries) {
    meshes.push_back({array_in<Vec3<Real>>(table, geometry.vertices),
                      array_in<Triangle>(table, geometry.triangles)});
    if (header.has_masks != 0) masks.push_back(geometry.mask);
  }
  const scene::Extent extent{{header.lower[0], header.lower[1], header.lower[2]},
                             {header.upper[0], header.upper[1], header.upper[2]},
                             header.smallest,
                             header.all_floats != 0};
  impl->geometries = scene::Geometries<Real>(meshes, masks, extent, path);
  impl->quality = static_cast<Quality>(header.quality);
  impl->tree = tree_in(*impl->file, header);
  if (impl->tree.layout == bvh::Layout::Compact) {
    impl->geometries.expect_no_copies();
    impl->tree.primitives = &impl->geometries;
  }
  impl->built_cost = header.built_cost;
  impl->kernel = &kernels::active_kernel();

  parallel::with_threads(options.work.threads, [&] {
    impl->file->expect(header.nodes.offset, header.nodes.bytes);
    const std::uint32_t triangles = impl->geometries.size();
    const char* fault = scene::fault_of(impl->tree, triangles);
    if (fault == nullptr && options.verify) {
      verify_checksums(table, options.work);
      impl->geometries.examine();
      fault = scene::fault_of_leaves(impl->tree, triangles);
    }
    if (fault != nullptr) table.damaged(fault);
  });
  return Scene(std::move(impl));
}

template <class Real>
std::span<const MeshView<Real>> Scene<Real>::meshes() const {
  return impl_->geometries.meshes();
}

template Scene<float> Scene<float>::load(const std::string&, const LoadOptions&);
template Scene<double> Scene<double>::load(const std::string&, const LoadOptions&);
template std::span<const MeshView<float>> Scene<float>::meshes() const;
template std::span<const MeshView<double>> Scene<double>::meshes() const;

}  // namespace pierce
