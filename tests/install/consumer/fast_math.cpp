// SPDX-License-Identifier: Apache-2.0
//
// A user's program that is built with -ffast-math, which has denormal numbers flushed to zero from
// its start: a mesh of denormal numbers and one of ordinary ones; and numbers that are none, which
// must be refused though this program has functions of its own, and the linker might take them for
// the library's, for which every number is finite. Exit status 0 if all answers are the exact ones.
// Looks at bits only: its own arithmetic is not to be trusted.
#include <pierce/pierce.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace {

int wrong = 0;

void expect(const char* what, float got, std::uint32_t bits) {
  if (std::bit_cast<std::uint32_t>(got) == bits) return;
  std::printf("%s: %08x, not %08x\n", what, std::bit_cast<std::uint32_t>(got), bits);
  ++wrong;
}

// i times a unit whose multiples are these: 2^-140, or 1.
float times(bool tiny, int i) {
  if (!tiny) return static_cast<float>(i);
  const std::uint32_t sign = i < 0 ? 0x80000000U : 0U;
  return std::bit_cast<float>(sign | (512U * static_cast<std::uint32_t>(i < 0 ? -i : i)));
}

void ask(bool tiny) {
  const auto at = [&](int x, int y, int z) {
    return pierce::Vec3<float>{times(tiny, x), times(tiny, y), times(tiny, z)};
  };
  const std::vector<pierce::Vec3<float>> vertices = {at(0, 0, 0), at(3, 0, 0), at(3, 3, 0)};
  const std::vector<pierce::Triangle> triangles = {{0, 1, 2}};
  const auto scene = pierce::Scene<float>::build({vertices, triangles});
  const std::vector<pierce::Ray<float>> rays(5000, {at(2, 1, 7), at(0, 0, -3)});
  std::vector<pierce::Hit<float>> hits(rays.size());
  scene.closest_hits(rays, hits);
  hits.push_back(scene.closest_hit(rays[0]).value_or(pierce::Hit<float>{}));
  for (const auto& hit : hits) {
    expect("t", hit.t, 0x40155555);  // 7/3
    expect("u", hit.u, 0x3eaaaaab);  // 1/3
    expect("v", hit.v, 0x3eaaaaab);
    expect("w", hit.w, 0x3eaaaaab);
  }
  const auto near = scene.nearest_point(at(2, 1, 7));
  expect("distance", near ? near->distance : 0, tiny ? 7 * 512 : 0x40e00000);
}

// The functions that this program has, too; called in a way that they cannot be inlined.
template <class Real>
bool no_number_is_finite(Real x) {
  bool (*volatile is_finite)(Real) = std::isfinite;
  bool (*volatile is_nan)(Real) = std::isnan;
  bool (*volatile is_infinite)(Real) = std::isinf;
  return is_finite(x) && !is_nan(x) && !is_infinite(x);
}

template <class Real>
void refuse(Real not_a_number) {
  if (!no_number_is_finite(not_a_number)) {
    std::puts("not a program with -ffast-math");
    ++wrong;
  }
  const std::vector<pierce::Vec3<Real>> vertices = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}};
  const std::vector<pierce::Triangle> triangles = {{0, 1, 2}};
  std::vector<pierce::Instance<Real>> placed = {{{vertices, triangles}, {}}};
  placed[0].transform.rows[1][3] = not_a_number;
  try {
    (void)pierce::Scene<Real>::build(std::span<const pierce::Instance<Real>>(placed));
    std::puts("a transform that is not a number was not refused");
    ++wrong;
  } catch (const pierce::Error& error) {
    if (error.code() == pierce::ErrorCode::InvalidArgument) return;
    std::printf("refused, but: %s\n", error.what());
    ++wrong;
  }
}

}  // namespace

int main() {
  ask(false);
  ask(true);
  refuse(std::bit_cast<float>(0x7fc00000U));
  refuse(std::bit_cast<double>(0x7ff8000000000000U));
  return wrong == 0 ? 0 : 1;
}
