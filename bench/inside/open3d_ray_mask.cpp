// SPDX-License-Identifier: Apache-2.0
//
// Makes Debian 12's Open3D find hits. Open3D leaves the mask of its rays at 0, which its own build
// of Embree ignores; Debian's Embree heeds masks, and so no ray meets anything. Loaded before
// Open3D (scripts/inside_figures.py does so), this stands in front of the one function and sets the
// masks.
#include <dlfcn.h>
#include <embree3/rtcore.h>

#include <cstddef>

namespace {

using Intersect = void (*)(RTCScene, RTCIntersectContext*, RTCRayHit*, unsigned, std::size_t);

}  // namespace

extern "C" void rtcIntersect1M(RTCScene scene, RTCIntersectContext* context, RTCRayHit* rays,
                               unsigned count, std::size_t stride) {
  static const auto embree = reinterpret_cast<Intersect>(
      dlsym(dlopen("libembree3.so.3", RTLD_NOW | RTLD_NOLOAD), "rtcIntersect1M"));
  for (unsigned i = 0; i < count; ++i) {
    auto* ray = reinterpret_cast<RTCRayHit*>(reinterpret_cast<char*>(rays) + i * stride);
    ray->ray.mask = ~0U;
  }
  embree(scene, context, rays, count, stride);
}
