// SPDX-License-Identifier: Apache-2.0
//
// The words of the library: rays, triangles, meshes, hits.
//
// Input numbers are taken as the exact real numbers that the floats or doubles stand for.
// All types here are plain values; none of them owns memory but HitLists.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <ranges>
#include <span>
#include <type_traits>
#include <vector>

namespace pierce {

/// A point or a direction. `Real` is float or double.
template <class Real>
struct Vec3 {
  Real x, y, z;
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

/// No end: what t_max is unless you say otherwise, and the t of a miss. (A constant rather than a
/// call: g++ 12 breaks down over a call in a default member initialiser when templates brace-list
/// rays.)
template <class Real>
inline constexpr Real kInfinity = std::numeric_limits<Real>::infinity();

/// The set of points `origin + t * direction` with `t_min <= t <= t_max`.
///
/// `direction` need not have unit length, and t is measured in units of it. A ray is valid when its
/// origin and direction are finite, the direction is not zero, and neither end of the range is NaN
/// (infinities are welcome: -inf, inf makes it a line). `t_min > t_max` is an empty range: no hits.
template <class Real>
struct Ray {
  static_assert(
      std::numeric_limits<Real>::has_infinity,
      "a Ray over exact numbers: include pierce/textbook.h, which makes its range unbounded");
  Vec3<Real> origin, direction;
  Real t_min = 0;
  Real t_max = kInfinity<Real>;
};

/// Three indices into the vertices of a mesh: the corners a, b, c.
using Triangle = std::array<std::uint32_t, 3>;

/// A span over an array that somebody else keeps. A temporary vector is nobody's: to make a view of
/// one does not compile. (Vectors, std::array and other arrays that have a name, and spans, do.)
template <class T>
class ArrayView : public std::span<const T> {
 public:
  constexpr ArrayView() = default;
  constexpr ArrayView(const T* data, std::size_t count) : std::span<const T>(data, count) {}
  template <std::ranges::contiguous_range Range>
  requires std::ranges::sized_range<Range> && std::ranges::borrowed_range<Range> &&
      std::same_as<std::ranges::range_value_t<Range>, T> &&
      (!std::same_as<std::remove_cvref_t<Range>, ArrayView>)constexpr ArrayView(Range&& range)
      : std::span<const T>(std::ranges::data(range), std::ranges::size(range)) {}
};

/// A mesh in the caller's memory. Nothing is copied: whoever builds a Scene from a view keeps the
/// arrays alive and unchanged for as long as the scene is used. (Mesh, in pierce/mesh.h, owns its
/// arrays, and a scene can take it over.)
template <class Real>
struct MeshView {
  ArrayView<Vec3<Real>> vertices;
  ArrayView<Triangle> triangles;
};

/// Which side of the triangle the ray meets. With `N = (b - a) x (c - a)`, Front means
/// `N . direction < 0`: the corners run counter-clockwise as seen from the ray's origin.
enum class Facing : std::uint8_t { Front, Back };

/// Stands for "no triangle" and "no geometry".
inline constexpr std::uint32_t kNone = 0xffffffffu;

/// Names one triangle of a scene; the default names none.
struct TriangleRef {
  std::uint32_t geometry = kNone;
  std::uint32_t triangle = kNone;
  friend bool operator==(const TriangleRef&, const TriangleRef&) = default;
};

/// Where a ray pierces a triangle: `origin + t direction = w a + u b + v c`, `w = 1 - u - v`.
///
/// Each of t, u, v, w is the exact value rounded once to the nearest Real (ties to even; zero is
/// +0), so u + v + w need not be exactly 1. A default-made Hit is a miss.
template <class Real>
struct Hit {
  Real t = kInfinity<Real>;
  Real u = 0, v = 0, w = 0;
  std::uint32_t geometry = kNone;  ///< index of the mesh in the scene
  std::uint32_t triangle = kNone;  ///< index of the triangle in that mesh; kNone: no hit
  Facing facing = Facing::Front;

  /// The triangle that was hit: a Hit can be given where options ask for a triangle.
  operator TriangleRef() const { return {geometry, triangle}; }
  friend bool operator==(const Hit&, const Hit&) = default;
};

/// Whether a hit exactly at t = t_min counts (Closed) or not (OpenStart). t_max always counts.
enum class Range : std::uint8_t { Closed, OpenStart };

/// On which side of a hit to go on: Before it, where the ray comes from (for shadow rays and
/// reflections), or Beyond it (for what passes through).
enum class Side : std::uint8_t { Before, Beyond };

/// How often a ray passes through a surface, each passage counted once.
///
/// Defined by an infinitesimal symbolic shift of the origin, o + (e, e^2, e^3) with e -> 0, so that
/// a passage through an edge or a vertex is one passage and a touch is none (or two). For a closed
/// mesh `count` is odd iff the (shifted) origin is inside, and `signed_count` is its winding
/// number.
struct Crossings {
  std::uint32_t count = 0;
  std::int32_t signed_count = 0;   ///< leaving (N . d > 0) counts +1, entering -1
  bool origin_on_surface = false;  ///< the origin lies exactly on some closed triangle
  friend bool operator==(const Crossings&, const Crossings&) = default;
};

/// Where a point lies with respect to a closed mesh.
enum class Location : std::int8_t { Outside = -1, OnSurface = 0, Inside = 1 };

/// All hits of a batch of rays in compressed rows: the hits of ray i are
/// `hits[offsets[i]] ... hits[offsets[i + 1] - 1]`, ordered by (exact t, geometry, triangle).
template <class Real>
struct HitLists {
  std::vector<std::uint64_t> offsets;  ///< one more than there are rays
  std::vector<Hit<Real>> hits;

  [[nodiscard]] std::span<const Hit<Real>> of(std::size_t ray) const {
    return std::span(hits).subspan(offsets[ray], offsets[ray + 1] - offsets[ray]);
  }
};

/// Is handed the lists of the rays first, first + 1, ... of a batch.
template <class Real>
using HitListsConsumer = std::function<void(std::uint64_t first, const HitLists<Real>& lists)>;

}  // namespace pierce
