// SPDX-License-Identifier: Apache-2.0
#include "io/ear_cutter.h"

#include <algorithm>
#include <cmath>

#include "predicate/axis_passage.h"

namespace pierce::io {
namespace {

// The two coordinates of a shadow; which is which does not matter.
double coordinate(const Vec3<double>& p, std::uint8_t axis, std::size_t k) {
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
    corners_.push_back({before, after, kNone, 0, false});
    ask(i);
  }
  fill_strips();
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

// At the back of the queue; its older place there no longer counts.
void EarCutter::ask(std::uint32_t i) {
  if (corners_[i].gone) return;
  queue_.push_back({i, ++corners_[i].asked});
}

// The next ear; if there is none, a corner without area, for nothing else can be left between.
std::uint32_t EarCutter::next_corner() {
  while (!queue_.empty()) {
    const auto [i, asked] = queue_.front();
    queue_.pop_front();
    if (corners_[i].gone || corners_[i].asked != asked) continue;
    const int here = turn_at(i);
    if (here == 0) flat_.push_back(i);
    if (here <= 0) continue;
    const std::uint32_t blocker = blocker_of(i);
    if (blocker == kNone) return i;
    waits_.push_back({i, corners_[blocker].waits});
    corners_[blocker].waits = static_cast<std::uint32_t>(waits_.size() - 1);
  }
  while (!flat_.empty()) {
    const std::uint32_t i = flat_.back();
    flat_.pop_back();
    if (!corners_[i].gone && turn_at(i) == 0) return i;
  }
  return kNone;
}

// Who may be an ear now is asked again: its neighbours, and those in whose triangle it was.
void EarCutter::remove(std::uint32_t i) {
  corners_[i].gone = true;
  const std::uint32_t before = corners_[i].before, after = corners_[i].after;
  corners_[before].after = after;
  corners_[after].before = before;
  ask(before);
  ask(after);
  for (std::uint32_t k = corners_[i].waits; k != kNone; k = waits_[k].next) ask(waits_[k].corner);
}

// Positive if the polygon is convex there.
int EarCutter::turn_at(std::uint32_t i) const {
  const Corner& corner = corners_[i];
  return sign_ * turn(points_[corner.before], points_[i], points_[corner.after], axis_);
}

// A corner that lies in the triangle of this one.
std::uint32_t EarCutter::blocker_of(std::uint32_t i) const {
  const Vec3<double>&a = points_[corners_[i].before], &b = points_[i],
        &c = points_[corners_[i].after];
  const auto ends = [&](std::size_t k) {
    return std::minmax({coordinate(a, axis_, k), coordinate(b, axis_, k), coordinate(c, axis_, k)});
  };
  const auto [left, right] = ends(0);
  const auto [low, high] = ends(1);
  for (const Strip& strip : strips_) {
    if (strip.right < left) continue;
    if (strip.left > right) break;
    const auto end = places_.begin() + strip.end;
    auto place = std::lower_bound(places_.begin() + strip.begin, end, low,
                                  [](const Place& at, double y) { return at.y < y; });
    for (; place != end && place->y <= high; ++place) {
      if (place->x < left || place->x > right || corners_[place->corner].gone) continue;
      const Vec3<double>& q = points_[place->corner];
      // A border that touches itself has corners in the same place.
      if (q == a || q == b || q == c) continue;
      if (sign_ * turn(a, b, q, axis_) >= 0 && sign_ * turn(b, c, q, axis_) >= 0 &&
          sign_ * turn(c, a, q, axis_) >= 0) {
        return place->corner;
      }
    }
  }
  return kNone;
}

// As many strips as corners in each.
void EarCutter::fill_strips() {
  const std::size_t count = points_.size();
  places_.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    places_.push_back({coordinate(points_[i], axis_, 0), coordinate(points_[i], axis_, 1), i});
  }
  std::sort(places_.begin(), places_.end(),
            [](const Place& p, const Place& q) { return p.x < q.x; });
  strips_.clear();
  const auto size = static_cast<std::size_t>(std::sqrt(static_cast<double>(count)));
  for (std::size_t begin = 0; begin < count; begin += size) {
    const std::size_t end = std::min(count, begin + size);
    strips_.push_back({places_[begin].x, places_[end - 1].x, static_cast<std::ptrdiff_t>(begin),
                       static_cast<std::ptrdiff_t>(end)});
    std::sort(places_.begin() + strips_.back().begin, places_.begin() + strips_.back().end,
              [](const Place& p, const Place& q) { return p.y < q.y; });
  }
}

}  // namespace pierce::io
