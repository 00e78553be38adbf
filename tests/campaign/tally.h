// SPDX-License-Identifier: Apache-2.0
//
// What the campaign has compared, and what differed.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "pierce/nearest.h"
#include "pierce/types.h"

namespace pierce::campaign {

/// Equal, and zeros of the same sign: the library promises +0.
template <class Real>
bool same(Real p, Real q) {
  return p == q && std::signbit(p) == std::signbit(q);
}
template <class Real>
bool same(const Vec3<Real>& p, const Vec3<Real>& q) {
  return same(p.x, q.x) && same(p.y, q.y) && same(p.z, q.z);
}
template <class Real>
bool same(const Hit<Real>& p, const Hit<Real>& q) {
  return p == q && same(p.t, q.t) && same(p.u, q.u) && same(p.v, q.v) && same(p.w, q.w);
}
template <class Real>
bool same(const NearestPoint<Real>& p, const NearestPoint<Real>& q) {
  return p == q && same(p.point, q.point) && same(p.distance, q.distance) && same(p.u, q.u) &&
         same(p.v, q.v) && same(p.w, q.w);
}
template <class Real>
bool same(const std::vector<Hit<Real>>& p, const std::vector<Hit<Real>>& q) {
  if (p.size() != q.size()) return false;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (!same(p[i], q[i])) return false;
  }
  return true;
}
inline bool same(const Crossings& p, const Crossings& q) { return p == q; }
inline bool same(bool p, bool q) { return p == q; }
inline bool same(std::uint64_t p, std::uint64_t q) { return p == q; }
inline bool same(Location p, Location q) { return p == q; }

template <class Real>
void show(std::ostream& out, const Hit<Real>& hit) {
  out << hit.t << ' ' << hit.u << ' ' << hit.v << ' ' << hit.w << " of " << hit.geometry << '/'
      << hit.triangle << (hit.facing == Facing::Front ? " front" : " back");
}
template <class Real>
void show(std::ostream& out, const Vec3<Real>& p) {
  out << p.x << ' ' << p.y << ' ' << p.z;
}
template <class Real>
void show(std::ostream& out, const NearestPoint<Real>& p) {
  out << p.distance << " at " << p.point.x << ' ' << p.point.y << ' ' << p.point.z << " uvw " << p.u
      << ' ' << p.v << ' ' << p.w << " of " << p.geometry << '/' << p.triangle << " feature "
      << int(p.feature);
}
template <class Real>
void show(std::ostream& out, const std::vector<Hit<Real>>& hits) {
  for (const auto& hit : hits) {
    out << "[";
    show(out, hit);
    out << "] ";
  }
}
inline void show(std::ostream& out, const Crossings& p) {
  out << p.count << " signed " << p.signed_count << (p.origin_on_surface ? " on surface" : "");
}
inline void show(std::ostream& out, bool p) { out << p; }
inline void show(std::ostream& out, std::uint64_t p) { out << p; }
inline void show(std::ostream& out, Location p) { out << int(p); }
inline void show(std::ostream& out, float p) { out << p; }
inline void show(std::ostream& out, double p) { out << p; }

class Tally {
 public:
  /// Counts the answer, and keeps it if it is not what it should be. `where` is said of it.
  template <class Answer, class Where>
  void compare(const std::string& query, const Answer& wanted, const Answer& got, Where&& where) {
    ++counts_[query];
    if (same(wanted, got)) return;
    std::ostringstream text;
    text << query << ' ' << where() << std::hexfloat << ": wanted ";
    show(text, wanted);
    text << ", got ";
    show(text, got);
    differences_.push_back(text.str());
  }
  void fail(const std::string& text) { differences_.push_back(text); }
  void count(const std::string& query) { ++counts_[query]; }

  [[nodiscard]] const auto& counts() const { return counts_; }
  std::vector<std::string> take_differences() { return std::exchange(differences_, {}); }

 private:
  std::map<std::string, std::uint64_t> counts_;
  std::vector<std::string> differences_;
};

}  // namespace pierce::campaign
