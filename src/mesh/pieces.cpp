// SPDX-License-Identifier: Apache-2.0
#include "mesh/pieces.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <utility>

#include "exact/scaled_integers.h"
#include "predicate/settle.h"
#include "support/finite.h"

namespace pierce::mesh {
namespace {

// One of the two ends of an edge.
struct End {
  std::uint32_t vertex, edge;
  std::uint32_t other;  // the vertex at the other end
  std::int64_t leaves;  // how many more run away from the vertex than to it
};

// A line through a vertex: the shortest integer vector along it whose first component that is not 0
// is positive.
using Line = std::array<exact::BigInt, 3>;

Line line_through(const Vec3<double>& from, const Vec3<double>& to) {
  const std::array<std::pair<double, double>, 3> axes{
      {{from.x, to.x}, {from.y, to.y}, {from.z, to.z}}};
  exact::BitSpan bits;
  for (const auto& [p, q] : axes) {
    bits.include(p);
    bits.include(q);
  }
  Line line;
  exact::BigInt divisor = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    line[k] = exact::scaled_integer<exact::BigInt>(axes[k].second, bits.low) -
              exact::scaled_integer<exact::BigInt>(axes[k].first, bits.low);
    divisor = gcd(divisor, line[k]);
  }
  const auto first =
      std::find_if(line.begin(), line.end(), [](const exact::BigInt& x) { return !x.is_zero(); });
  if (first->sign() < 0) divisor = -divisor;
  for (exact::BigInt& x : line) x /= divisor;
  return line;
}

// Which edges hang together, and which such sets are at fault.
class Sets {
 public:
  explicit Sets(std::size_t edges) : parent_(edges), fault_(edges) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  std::uint32_t root(std::uint32_t edge) {
    while (parent_[edge] != edge) edge = parent_[edge] = parent_[parent_[edge]];
    return edge;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    if (a == b) return;
    const auto [low, high] = std::minmax(a, b);
    parent_[high] = low;
    fault_[low] |= fault_[high];
  }
  void blame(std::uint32_t edge) { fault_[root(edge)] = 1; }
  bool at_fault(std::uint32_t edge) { return fault_[root(edge)] != 0; }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint8_t> fault_;
};

template <class Real>
class Finder {
 public:
  Finder(std::span<const Vec3<Real>> vertices, Pieces what, std::size_t edges)
      : vertices_(vertices), what_(what), sets_(edges) {}

  // All ends at one vertex.
  void look_at(std::span<const End> ends) {
    if (ends.size() == 1 || !is_finite(ends)) {
      for (const End& end : ends) sets_.blame(end.edge);
      return;
    }
    if (ends.size() == 2) {  // by far the most frequent, and cheaper than lines
      const predicate::TriangleD corner{at(ends[0].vertex), at(ends[0].other), at(ends[1].other)};
      if (predicate::settle_has_area(corner)) {
        for (const End& end : ends) sets_.blame(end.edge);
      } else {
        add_line(ends, [](const End& end) -> const End& { return end; });
      }
      return;
    }
    lines_.clear();
    for (const End& end : ends) {
      lines_.emplace_back(line_through(at(end.vertex), at(end.other)), end);
    }
    std::sort(lines_.begin(), lines_.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0, next = 0; i < lines_.size(); i = next) {
      while (next < lines_.size() && lines_[next].first == lines_[i].first) ++next;
      add_line(std::span(lines_).subspan(i, next - i),
               [](const auto& entry) -> const End& { return entry.second; });
    }
  }

  std::vector<std::uint8_t> pairs(std::size_t edges) {
    std::vector<std::uint8_t> result(edges);
    for (std::uint32_t i = 0; i < edges; ++i) result[i] = sets_.at_fault(i) ? 0 : 1;
    return result;
  }

 private:
  [[nodiscard]] Vec3<double> at(std::uint32_t vertex) const {
    return predicate::to_double(vertices_[vertex]);
  }

  [[nodiscard]] bool is_finite(std::span<const End> ends) const {
    const auto finite = [this](std::uint32_t vertex) {
      const Vec3<double> p = at(vertex);
      return is_finite_number(p.x) && is_finite_number(p.y) && is_finite_number(p.z);
    };
    return finite(ends[0].vertex) &&
           std::all_of(ends.begin(), ends.end(), [&](const End& end) { return finite(end.other); });
  }

  // Ends at one vertex that lie on one line.
  template <class Entries, class EndOf>
  void add_line(const Entries& entries, const EndOf& end_of) {
    std::int64_t sum = 0;
    const std::uint32_t first = end_of(entries.front()).edge;
    for (const auto& entry : entries) {
      sum += end_of(entry).leaves;
      sets_.join(first, end_of(entry).edge);
    }
    if (what_ == Pieces::Even ? sum % 2 != 0 : sum != 0) sets_.blame(first);
  }

  std::span<const Vec3<Real>> vertices_;
  Pieces what_;
  Sets sets_;
  std::vector<std::pair<Line, End>> lines_;
};

}  // namespace

template <class Real>
std::vector<std::uint8_t> pairs_in_pieces(std::span<const LooseEdge> edges,
                                          std::span<const Vec3<Real>> vertices, Pieces what,
                                          const scene::StopPoll& stop) {
  std::vector<End> ends;
  ends.reserve(2 * edges.size());
  for (std::uint32_t i = 0; i < edges.size(); ++i) {
    const auto& [from, to, surplus] = edges[i];
    ends.push_back({from, i, to, surplus});
    ends.push_back({to, i, from, -surplus});
  }
  std::sort(ends.begin(), ends.end(), [&stop](const End& a, const End& b) {
    stop.now();
    return std::tie(a.vertex, a.edge) < std::tie(b.vertex, b.edge);
  });
  Finder<Real> finder(vertices, what, edges.size());
  for (std::size_t i = 0, next = 0; i < ends.size(); i = next) {
    stop.now();
    while (next < ends.size() && ends[next].vertex == ends[i].vertex) ++next;
    finder.look_at(std::span(ends).subspan(i, next - i));
  }
  return finder.pairs(edges.size());
}

template std::vector<std::uint8_t> pairs_in_pieces(std::span<const LooseEdge>,
                                                   std::span<const Vec3<float>>, Pieces,
                                                   const scene::StopPoll&);
template std::vector<std::uint8_t> pairs_in_pieces(std::span<const LooseEdge>,
                                                   std::span<const Vec3<double>>, Pieces,
                                                   const scene::StopPoll&);

}  // namespace pierce::mesh
