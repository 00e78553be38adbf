// SPDX-License-Identifier: Apache-2.0
#include "scene/rays/after.h"

#include <string>

#include "scene/validate_input.h"
#include "support/first_offender.h"
#include "support/for_chunks.h"

namespace pierce::scene {
namespace {

template <class Real>
bool goes_on(const Geometries<Real>& geometries, const Ray<Real>& ray, const TriangleRef& after) {
  predicate::LadderCounts counts;
  After found;
  return after.triangle == kNone || find_hit(geometries, line_of(ray), after, found, counts);
}

template <class Real>
[[noreturn]] void refuse(const Geometries<Real>& geometries, const TriangleRef& after,
                         const std::string& who, std::uint64_t index, std::uint64_t count) {
  const std::string triangle = "triangle " + std::to_string(after.triangle) + " of geometry " +
                               std::to_string(after.geometry);
  throw Error(
      ErrorCode::InvalidArgument,
      "bad triangle to go on after" + who + ": " +
          (geometries.primitive(after) == kNone
               ? "there is no " + triangle + "; name one of the scene, or none"
               : "the ray's line does not hit " + triangle + "; give a hit of this ray, or none"),
      index, count);
}

}  // namespace

template <class Real>
void validate_after(const Geometries<Real>& geometries, const Ray<Real>& ray,
                    const TriangleRef& after) {
  if (!goes_on(geometries, ray, after)) refuse(geometries, after, "", Error::kNoIndex, 1);
}

template <class Real>
void validate_after(const Geometries<Real>& geometries, const RaySource<Real>& rays,
                    const BatchOptions& options) {
  if (options.after.empty()) return;
  FirstOffender bad;
  const WorkOptions quiet{.threads = options.work.threads, .stop = options.work.stop};
  for_chunks(rays.size(), quiet, kRaysPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Ray<Real> ray = rays[i];
      if (is_valid(ray) && !goes_on(geometries, ray, options.after[i])) bad.note(i);
    }
  });
  if (bad.count() == 0) return;
  refuse(geometries, options.after[bad.first()],
         ", of ray " + std::to_string(bad.first()) + counted(bad.count()), bad.first(),
         bad.count());
}

template void validate_after(const Geometries<float>&, const Ray<float>&, const TriangleRef&);
template void validate_after(const Geometries<double>&, const Ray<double>&, const TriangleRef&);
template void validate_after(const Geometries<float>&, const RaySource<float>&,
                             const BatchOptions&);
template void validate_after(const Geometries<double>&, const RaySource<double>&,
                             const BatchOptions&);

}  // namespace pierce::scene
