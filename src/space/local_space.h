// SPDX-License-Identifier: Apache-2.0
//
// A filter space of its own for a part of the scene, and the way there from the scene's: an affine
// map in double, exact by definition. The tree that stands there was built over a mesh as it is;
// where the scene has that mesh placed, every vertex rounded, the triangles that the tree knows are
// off by a little, and so is the ray once it is there: that is its blur (docs/algorithm.md, "Spaces
// of their own").
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "pierce/types.h"
#include "space/filter_ray.h"
#include "space/filter_space.h"

namespace pierce::space {

/// An affine map: row i times (x, y, z, 1) is coordinate i.
using Affine = std::array<std::array<double, 4>, 3>;

/// An axis-aligned box by its middle and half of its sides.
struct MiddleBox {
  Vec3<double> middle, half;
};

/// A mesh and where it is placed, as far as bounds on errors need to know.
struct PlacedExtent {
  Affine placement;   // from the mesh's coordinates to the scene's
  Vec3<double> size;  // no coordinate of a vertex is larger, in magnitude
  double ulp;         // each placed coordinate was rounded by this much of itself at most ...
  double tiny;        // ... or by this much
};

class LocalSpace;

/// How a ray got there.
enum class Brought {
  There,
  Misses,   // its line passes by
  Unknown,  // no float can tell anything of it
};

/// A ray in a local space, and where its tau lies on the scene's ray.
struct LocalRay {
  BlurredRay ray;
  double factor;  // local tau = scene's tau * factor - shift, exactly
  double shift;

  /// What the scene's ends of an interval, which are off by 2^-50 at most, are in local floats:
  /// rounded outward, or inward.
  struct Ends {
    float low, high;
  };
  [[nodiscard]] Ends outward(double low, double high) const {
    return {rounded_low(low), rounded_high(high)};
  }
  [[nodiscard]] Ends inward(double low, double high) const {
    const double a = place(low), b = place(high);
    return {static_cast<float>(a + pad(low, a)), static_cast<float>(b - pad(high, b))};
  }
  [[nodiscard]] float rounded_low(double low) const {
    const double tau = place(low);
    return static_cast<float>(tau - pad(low, tau));
  }
  [[nodiscard]] float rounded_high(double high) const {
    const double tau = place(high);
    return static_cast<float>(tau + pad(high, tau));
  }
  /// The scene's tau of local ones, rounded outward.
  [[nodiscard]] double scene_low(float tau) const {
    const double sum = static_cast<double>(tau) + shift;
    return (sum - 0x1p-50 * (std::fabs(sum) + std::fabs(shift))) / factor;
  }
  [[nodiscard]] double scene_high(float tau) const {
    const double sum = static_cast<double>(tau) + shift;
    return (sum + 0x1p-50 * (std::fabs(sum) + std::fabs(shift))) / factor;
  }

 private:
  // What is far out is cut off.
  [[nodiscard]] double place(double scene_tau) const {
    const auto limit = static_cast<double>(kTauLimit);
    return std::clamp(scene_tau * factor - shift, -limit, limit);
  }
  // The scene's tau is off by 2^-50; its product is exact; the difference is rounded, the sum of it
  // and the pad, too, and that is rounded to float by 2^-24 of itself, of which kTauPad is four
  // times as much.
  [[nodiscard]] double pad(double scene_tau, double tau) const {
    return factor * 0x1p-49 + 0x1p-50 * (std::fabs(scene_tau * factor) + std::fabs(shift)) +
           bounds::kTauPad * std::fabs(tau) + bounds::kTauFloorMoved;
  }
};

class LocalSpace {
 public:
  /// Nothing if there is none that is any good: the placement flattens the mesh, or nearly, or
  /// numbers are beyond all measure.
  static std::optional<LocalSpace> make(const AffineMap& scene, const AffineMap& local,
                                        const PlacedExtent& extent);

  /// Brings a ray there from the scene's filter space. Fills the whole of `out` if it is There.
  Brought bring(const TransformedRay& ray, LocalRay& out) const;
  /// The box of the image of a box of the scene's filter space; holds every placed triangle's copy
  /// that the box touches.
  [[nodiscard]] MiddleBox to_local(const MiddleBox& box) const;
  /// The box, in the scene's filter space, of what is placed from this box of the local one.
  [[nodiscard]] MiddleBox to_scene(const MiddleBox& box) const;

 private:
  // What `bring` reads, together: the columns of to_local_, and the last one.
  std::array<std::array<double, 4>, 3> columns_{};
  std::array<double, 4> offset_{};
  double size_ = 0;        // of to_local_: the magnitudes of a row's first three numbers, added up
  double origin_off_ = 0;  // what a ray's origin is off by once it is there, unless it was moved
  double blur_ = 0;        // of the placed vertices, in local filter space
  Affine to_local_;        // from the scene's filter space
  Affine to_scene_;        // about the inverse
  Vec3<double> off_;       // blur_ in the scene's: what to_scene may be wrong by
};

}  // namespace pierce::space
