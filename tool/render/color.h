// SPDX-License-Identifier: Apache-2.0
//
// Colours: red, green, blue, 0 to 1.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "pierce/vector.h"
#include "render/sampling.h"

namespace pierce::tool {

using Color = Vec3<float>;

[[nodiscard]] inline Color blend(const Color& a, const Color& b, float k) {
  return (1 - k) * a + k * b;
}

/// Light to the numbers of a picture (the sRGB curve, IEC 61966-2-1), componentwise.
[[nodiscard]] inline Color encode_light(const Color& light) {
  const auto encode = [](float x) {
    x = std::clamp(x, 0.0F, 1.0F);
    return x <= 0.0031308F ? 12.92F * x : 1.055F * std::pow(x, 1 / 2.4F) - 0.055F;
  };
  return {encode(light.x), encode(light.y), encode(light.z)};
}

/// Dark blue over green to yellow, evenly in lightness; k from 0 to 1. (Five points of viridis by
/// S. van der Walt and N. Smith, in the public domain.)
[[nodiscard]] inline Color lightness_map(float k) {
  constexpr Color kPoints[] = {{0.267F, 0.005F, 0.329F},
                               {0.229F, 0.322F, 0.546F},
                               {0.128F, 0.567F, 0.551F},
                               {0.369F, 0.789F, 0.383F},
                               {0.993F, 0.906F, 0.144F}};
  const float at = std::clamp(k, 0.0F, 1.0F) * 4;
  const int i = std::min(static_cast<int>(at), 3);
  return blend(kPoints[i], kPoints[i + 1], at - static_cast<float>(i));
}

/// A friendly colour of its own for every number.
[[nodiscard]] inline Color color_of(std::uint64_t number) {
  const std::uint64_t h = mix(number);
  const auto part = [&](unsigned shift) {
    return static_cast<float>((h >> shift) & 0xffffU) / 65535.0F;
  };
  const float hue = 6 * part(0), gray = 0.30F + 0.25F * part(16);
  const auto wave = [&](float offset) {
    const float x = std::fabs(std::fmod(hue + offset, 6.0F) - 3) - 1;
    return gray + (0.95F - gray) * std::clamp(x, 0.0F, 1.0F);
  };
  return {wave(0), wave(4), wave(2)};
}

}  // namespace pierce::tool
