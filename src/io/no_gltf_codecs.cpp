// SPDX-License-Identifier: Apache-2.0
//
// In place of gltf_codecs.cpp where the libraries are not to be had
// (PIERCE_INSTALLED_LIBRARIES=OFF).
#include "io/gltf_codecs.h"

namespace pierce::io {

bool have_gltf_codecs() { return false; }

std::string decode_draco(std::string_view /*bytes*/, std::span<const std::uint32_t> /*ids*/,
                         DracoMesh& /*mesh*/) {
  return "this pierce was built without Draco";
}

std::string decode_meshopt(std::string_view /*bytes*/, MeshoptMode /*mode*/,
                           MeshoptFilter /*filter*/, std::uint64_t /*count*/,
                           std::uint64_t /*stride*/, std::string& /*out*/) {
  return "this pierce was built without meshoptimizer";
}

}  // namespace pierce::io
