// SPDX-License-Identifier: Apache-2.0
//
// A loaded scene to a scene file, with the names of its geometries and a progress bar.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <vector>

#include "interrupt.h"
#include "loaded_scene.h"
#include "progress_bar.h"

namespace pierce::tool {

template <class Real>
void save_scene(const LoadedScene<Real>& loaded, const std::string& path, unsigned threads) {
  std::vector<std::string> names;
  for (const Geometry& geometry : loaded.meshes().geometries()) names.push_back(geometry.name());
  ProgressBar bar("save");
  const interrupt::Graceful graceful;
  loaded.scene().save(
      path, {.names = names,
             .work = {.threads = threads, .progress = bar.callback(), .stop = interrupt::stop()}});
}

/// Sixteen digits of hexadecimal.
[[nodiscard]] inline std::string fingerprint_text(std::uint64_t fingerprint) {
  return fmt::format("{:016x}", fingerprint);
}

}  // namespace pierce::tool
