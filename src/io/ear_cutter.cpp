// SPDX-License-Identifier: Apache-2.0
#include "io/ear_cutter.h"

#include "predicate/axis_passage.h"

namespace pierce::io {
namespace {

// The two coordinates of a shadow, so that areas have the sign of `turn`.
double shadow_coordinate(const Vec3<double>& p, std::uint8_t axis, std::size_t k) {
  const std::size_t i = (axis + 1 + k) % 3;
  return i == 0 ? p.x : i == 1 ? p.y : p.z;
}

}  // namespace

int turn(const Vec3<double>& a, const Vec3<double>& b, const Vec3<double>& c, std::uint8_t axis) {
  predicate::LadderCounts unused;
  return predicate::decide_shadow(a, axis, {a, b, c}, unused).facing;
}

bool EarCutter::cut(std::span<const Vec3<double>> points, std::uint8_t axis, int sign, Ears& ears) {
  points_ = points;
  axis_ = axis;
  sign_ = sign;
  const auto count = static_cast<std::uint32_t>(points.size());
  corners_.clear();
  queue_.clear();
  waits_.clear();
  flat_.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t before = (i == 0 ? count : i) - 1, after = i + 1 == count ? 0 : i + 1;
    corners_.push_back({before, after, kNone, kNone, 0, false});
  }
  shadows_.clear();
  for (const Vec3<double>& p : points) {
    shadows_.push_back({shadow_coordinate(p, axis, 0), shadow_coordinate(p, axis, 1)});
  }
  tree_.build(shadows_);
  for (std::uint32_t i = 0; i < count; ++i) ask(i);
  for (std::uint32_t left = count; left > 3; --left) {
    const std::uint32_t corner = next_corner();
    if (corner == kNone) return false;
    ears.push_back({corners_[corner].before, corner, corners_[corner].after});
    remove(corner);
  }
  std::uint32_t first = 0;
  while (corners_[first].gone) ++first;
  const std::uint32_t second = corners_[first].after;
  ears.push_back({first, second, corners_[second].after});
  return turn_at(second) >= 0;
}

// At the back of the queue, or first if it is a spike; its older place there no longer counts.
void EarCutter::ask(std::uint32_t i) {
  if (corners_[i].gone) return;
  const Asked asked{i, ++corners_[i].asked};
  if (is_spike(i)) {
    queue_.push_front(asked);
  } else {
    queue_.push_back(asked);
  }
}

// Where the border goes back the way it came.
bool EarCutter::is_spike(std::uint32_t i) const {
  for (std::size_t k = 0; k < 2; ++k) {
    const auto along = [&](const ShadowPoint& p) { return k == 0 ? p.x : p.y; };
    const double a = along(shadows_[corners_[i].before]), b = along(shadows_[i]),
                 c = along(shadows_[corners_[i].after]);
    if ((a < b && b < c) || (c < b && b < a)) return false;
  }
  return turn_at(i) == 0;
}

// The next spike or ear; if there is none, a corner without area, for nothing else can be left
// between.
std::uint32_t EarCutter::next_corner() {
  while (!queue_.empty()) {
    const auto [i, asked] = queue_.front();
    queue_.pop_front();
    if (corners_[i].gone || corners_[i].asked != asked) continue;
    const int here = turn_at(i);
    if (here == 0 && is_spike(i)) return i;
    if (here == 0) flat_.push_back(i);
    if (here <= 0) continue;
    const std::uint32_t blocker = blocker_of(i);
    if (blocker == kNone) return i;
    const Vec3<double>& q = points_[blocker];
    const bool touches =
        q == points_[i] || q == points_[corners_[i].before] || q == points_[corners_[i].after];
    std::uint32_t& first = touches ? corners_[blocker].touching : corners_[blocker].waiting;
    waits_.push_back({i, first});
    first = static_cast<std::uint32_t>(waits_.size() - 1);
  }
  while (!flat_.empty()) {
    const std::uint32_t i = flat_.back();
    flat_.pop_back();
    if (!corners_[i].gone && turn_at(i) == 0) return i;
  }
  return kNone;
}

// Who may be an ear now is asked again: its neighbours, those in whose triangle it was, and those
// in whose triangle an edge of its neighbours was.
void EarCutter::remove(std::uint32_t i) {
  corners_[i].gone = true;
  tree_.remove(i);
  const std::uint32_t before = corners_[i].before, after = corners_[i].after;
  corners_[before].after = after;
  corners_[after].before = before;
  ask(before);
  ask(after);
  for (std::uint32_t* first : {&corners_[i].waiting, &corners_[i].touching,
                               &corners_[before].touching, &corners_[after].touching}) {
    for (std::uint32_t k = *first; k != kNone; k = waits_[k].next) ask(waits_[k].corner);
    *first = kNone;
  }
}

// Positive if the polygon is convex there.
int EarCutter::turn_at(std::uint32_t i) const {
  const Corner& corner = corners_[i];
  return sign_ * turn(points_[corner.before], points_[i], points_[corner.after], axis_);
}

// A border that touches itself has corners in the same place: whether an edge of corner k, which
// lies at x, begins within the triangle x, y, z.
bool EarCutter::enters(std::uint32_t k, const Vec3<double>& x, const Vec3<double>& y,
                       const Vec3<double>& z) const {
  const auto begins_within = [&](const Vec3<double>& p) {
    return sign_ * turn(x, y, p, axis_) > 0 && sign_ * turn(z, x, p, axis_) > 0;
  };
  return begins_within(points_[corners_[k].before]) || begins_within(points_[corners_[k].after]);
}

// A corner that lies in the triangle of this one, or whose edge does.
std::uint32_t EarCutter::blocker_of(std::uint32_t i) const {
  const Vec3<double>&a = points_[corners_[i].before], &b = points_[i],
        &c = points_[corners_[i].after];
  const auto in_the_way = [&](std::uint32_t k) {
    if (k == i || k == corners_[i].before || k == corners_[i].after) return false;
    const Vec3<double>& q = points_[k];
    return q == a   ? enters(k, a, b, c)
           : q == b ? enters(k, b, c, a)
           : q == c ? enters(k, c, a, b)
                    : sign_ * turn(a, b, q, axis_) >= 0 && sign_ * turn(b, c, q, axis_) >= 0 &&
                          sign_ * turn(c, a, q, axis_) >= 0;
  };
  return tree_.find({shadows_[corners_[i].before], shadows_[i], shadows_[corners_[i].after]}, sign_,
                    in_the_way);
}

}  // namespace pierce::io
