// SPDX-License-Identifier: Apache-2.0
//
// Which triangles of a mesh come near a line: everything that could be hit, and little else, so
// that the oracle can look at each of them with exact arithmetic. It shares nothing with the search
// tree that it helps to check: triangles are sorted into clusters once, and each ray looks at all
// clusters and all triangles of those that it comes near.
//
// A cluster or triangle is left out only if its points lie strictly on one side of a plane that
// holds the line and is parallel to a coordinate axis. For the plane parallel to z that is
//
//   f(p) = (p.x - o.x) d.y - (p.y - o.y) d.x
//
// Each of the two terms A is computed as A' with |A' - A| <= 2^-51 |A'| + 2^-1073 (two roundings,
// one underflow); the difference adds 2^-53 (|A'| + |B'|). So |f'| > 2^-50 (|A'| + |B'|) + 2^-1000
// proves the sign, whatever the numbers; with an overflow, the comparison with inf or NaN fails and
// nothing is left out. Meshes are brought to size 1 by a power of two first, which can only change
// numbers under 2^-1022, and those by less than 2^-1074.
#pragma once

#include <cstdint>
#include <vector>

#include "pierce/types.h"

namespace pierce::tool {

class NearTriangles {
 public:
  template <class Real>
  explicit NearTriangles(MeshView<Real> mesh);

  /// Replaces `out` by the triangles near the ray's line, in no particular order.
  template <class Real>
  void find(const Ray<Real>& ray, std::vector<std::uint32_t>& out) const;

 private:
  struct Box {
    Vec3<double> low, high;
    void grow(const Vec3<double>& p);
  };
  struct Corners {
    Vec3<double> a, b, c;
    std::uint32_t triangle;
  };
  struct Cluster {
    Box box;
    std::size_t begin, end;  // in sorted_
  };

  void sort_into_clusters();

  int scale_ = 0;                // coordinates here are 2^scale_ times the mesh's
  std::vector<Corners> sorted_;  // so that neighbours in space are near each other
  std::vector<Cluster> clusters_;
};

}  // namespace pierce::tool
