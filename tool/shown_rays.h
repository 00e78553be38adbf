// SPDX-License-Identifier: Apache-2.0
//
// Rays and hits that are to be looked at: in a page (pierce view) or a picture (pierce render).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/rays.h"
#include "io/view_page.h"
#include "pierce/scene.h"

namespace pierce::tool {

/// The file of --rays; none if `path` is empty. Throws Error (BadFile) if they are too many to be
/// looked at.
[[nodiscard]] std::optional<io::RayFile> open_shown_rays(const std::string& path);

template <class Real>
[[nodiscard]] std::vector<Ray<Real>> read_shown_rays(const std::optional<io::RayFile>& file);

/// Hits as `pierce cast` writes them, of the first or of all. If none says of which ray it is, each
/// is its row's.
template <class Real>
[[nodiscard]] std::vector<io::ViewHit<Real>> read_shown_hits(const std::string& path);

/// The first hit of each ray; `name` is the rays'.
template <class Real>
[[nodiscard]] std::vector<io::ViewHit<Real>> first_hits(const std::string& name,
                                                        const Scene<Real>& scene,
                                                        std::span<const Ray<Real>> rays,
                                                        unsigned threads);

}  // namespace pierce::tool
