// SPDX-License-Identifier: Apache-2.0
//
// Whether edges pair up, by the definitions: they are cut wherever another one of the same line
// ends, in integers, and the uses of each piece are counted, from one end of the line to the other.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "campaign/world.h"

namespace pierce::campaign {

/// How often edges, by position, are used one way and the other.
class EdgeCounts {
 public:
  bool even = true, balanced = true;
  /// The same when edges have been cut.
  bool watertight_even = true, watertight = true;

  explicit EdgeCounts(const World& world) {
    Uses uses;
    for (const auto& [corners, ref] : world) {
      const std::array<Key, 3> k{key(corners.a), key(corners.b), key(corners.c)};
      for (int i = 0; i < 3; ++i) add(uses, k[i], k[(i + 1) % 3], 1);
    }
    look_at(uses, even, balanced);
    if (balanced) return;
    watertight_even = even || passes_in_pieces(uses, true);
    watertight = passes_in_pieces(uses, false);
  }

 private:
  using Key = std::tuple<double, double, double>;
  using Uses = std::map<std::pair<Key, Key>, std::pair<long, long>>;

  static Key key(const Point& p) { return {p.x + 0.0, p.y + 0.0, p.z + 0.0}; }
  static Point point(const Key& k) { return {std::get<0>(k), std::get<1>(k), std::get<2>(k)}; }

  // An edge from a vertex to itself is none.
  static void add(Uses& uses, const Key& p, const Key& q, long times) {
    if (p < q) uses[{p, q}].first += times;
    if (q < p) uses[{q, p}].second += times;
  }
  static void look_at(const Uses& uses, bool& even, bool& balanced) {
    for (const auto& [edge, use] : uses) {
      even = even && (use.first + use.second) % 2 == 0;
      balanced = balanced && use.first == use.second;
    }
  }
  static bool in_line(const Key& p, const Key& q, const Key& r) {
    Scale scale;
    scale.see(point(p)).see(point(q)).see(point(r));
    const IntVec a = scale.integers(point(p));
    return is_zero(cross(scale.integers(point(q)) - a, scale.integers(point(r)) - a));
  }

  /// A line, as numbers that all pairs of points on it give: the shortest integer vector from an
  /// earlier to a later point, and its moment about the origin.
  struct Line {
    IntVec along, moment;
    bool operator<(const Line& other) const {
      const auto numbers = [](const Line& l) {
        return std::tie(l.along.x, l.along.y, l.along.z, l.moment.x, l.moment.y, l.moment.z);
      };
      return numbers(*this) < numbers(other);
    }
  };
  static Line line_through(const Scale& scale, const Key& p, const Key& q) {
    const IntVec start = scale.integers(point(p));
    IntVec along = scale.integers(point(q)) - start;
    const Int divisor = gcd(gcd(along.x, along.y), along.z);
    for (Int* x : {&along.x, &along.y, &along.z}) *x /= divisor;
    return {along, cross(start, along)};
  }

  static bool passes_in_pieces(const Uses& uses, bool parity) {
    Uses loose;
    std::map<Key, std::vector<Key>> ends;  // of each vertex, the other ends
    for (const auto& [edge, use] : uses) {
      const long surplus = use.first - use.second;
      if (parity ? surplus % 2 == 0 : surplus == 0) continue;
      loose[edge] = use;
      ends[edge.first].push_back(edge.second);
      ends[edge.second].push_back(edge.first);
    }
    // Nearly all open meshes end here: a rim turns a corner.
    for (const auto& [vertex, others] : ends) {
      if (others.size() == 1) return false;
      if (others.size() == 2 && !in_line(vertex, others[0], others[1])) return false;
    }
    Scale scale;
    for (const auto& [vertex, others] : ends) scale.see(point(vertex));
    // On each line, the points where edges begin or end, in lexicographic order, and how many of
    // each direction begin there (ends count -1). Between two such points lies a piece.
    std::map<Line, std::map<Key, std::pair<long, long>>> lines;
    for (const auto& [edge, use] : loose) {
      auto& line = lines[line_through(scale, edge.first, edge.second)];
      auto& begin = line[edge.first];
      begin.first += use.first, begin.second += use.second;
      auto& end = line[edge.second];
      end.first -= use.first, end.second -= use.second;
    }
    for (const auto& [line, changes] : lines) {
      long forth = 0, back = 0;  // of the piece that begins here
      for (const auto& [at, change] : changes) {
        forth += change.first, back += change.second;
        if (parity ? (forth + back) % 2 != 0 : forth != back) return false;
      }
    }
    return true;
  }
};

/// Without triangles that have the corners of an earlier one, in whatever order.
inline World without_repeats(const World& world) {
  using Key = std::tuple<double, double, double>;
  std::set<std::array<Key, 3>> seen;
  World result;
  for (const Placed& placed : world) {
    std::array<Key, 3> corners;
    const std::array<const Point*, 3> points{&placed.corners.a, &placed.corners.b,
                                             &placed.corners.c};
    for (int i = 0; i < 3; ++i) {
      corners[i] = {points[i]->x + 0.0, points[i]->y + 0.0, points[i]->z + 0.0};
    }
    std::sort(corners.begin(), corners.end());
    if (seen.insert(corners).second) result.push_back(placed);
  }
  return result;
}

}  // namespace pierce::campaign
