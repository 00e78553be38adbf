// SPDX-License-Identifier: Apache-2.0
//
// The C interface over the C++ one: what is a struct there is viewed in place, what is thrown there
// becomes a code and a message.
#include "pierce/pierce_c.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "pierce/pierce.h"

struct pierce_scene_f32 {
  pierce::Scene<float> scene;
  bool views;
};
struct pierce_scene_f64 {
  pierce::Scene<double> scene;
  bool views;
};

namespace {

using namespace pierce;

// The structs of both interfaces are the same to the byte.
template <class C, class Cpp>
constexpr bool kSame = sizeof(C) == sizeof(Cpp) && alignof(C) == alignof(Cpp) &&
                       std::is_trivially_copyable_v<C>&& std::is_trivially_copyable_v<Cpp>;
static_assert(kSame<pierce_ray_f32, Ray<float>> && kSame<pierce_ray_f64, Ray<double>>);
static_assert(offsetof(pierce_ray_f64, t_min) == offsetof(Ray<double>, t_min));
static_assert(kSame<pierce_hit_f32, Hit<float>> && kSame<pierce_hit_f64, Hit<double>>);
static_assert(offsetof(pierce_hit_f64, triangle) == offsetof(Hit<double>, triangle) &&
              offsetof(pierce_hit_f64, w) == offsetof(Hit<double>, w) &&
              offsetof(pierce_hit_f32, facing) == offsetof(Hit<float>, facing));
static_assert(kSame<pierce_nearest_f32, NearestPoint<float>> &&
              kSame<pierce_nearest_f64, NearestPoint<double>>);
static_assert(offsetof(pierce_nearest_f64, distance) == offsetof(NearestPoint<double>, distance) &&
              offsetof(pierce_nearest_f64, w) == offsetof(NearestPoint<double>, w) &&
              offsetof(pierce_nearest_f64, feature) == offsetof(NearestPoint<double>, feature));
static_assert(kSame<pierce_crossings, Crossings> && offsetof(pierce_crossings, origin_on_surface) ==
                                                        offsetof(Crossings, origin_on_surface));
static_assert(kSame<pierce_triangle_ref, TriangleRef>);
static_assert(kSame<pierce_statistics, Statistics> &&
              offsetof(pierce_statistics, rays_placed_exactly) ==
                  offsetof(Statistics, rays_placed_exactly));
static_assert(PIERCE_NON_FINITE_VERTEX == 1 + static_cast<int>(ErrorCode::NonFiniteVertex) &&
              PIERCE_INVALID_ARGUMENT == 1 + static_cast<int>(ErrorCode::InvalidArgument) &&
              PIERCE_BAD_FILE == 1 + static_cast<int>(ErrorCode::BadFile));
static_assert(static_cast<std::uint32_t>(PIERCE_NONE) == kNone);

pierce_code failed(pierce_error* error, pierce_code code, const char* message,
                   std::uint64_t index = Error::kNoIndex, std::uint64_t count = 1) noexcept {
  if (error != nullptr) {
    error->code = code;
    error->index = index;
    error->count = count;
    const std::size_t length = std::min(std::strlen(message), sizeof error->message - 1);
    std::memcpy(error->message, message, length);
    error->message[length] = '\0';
  }
  return code;
}

[[noreturn]] void refuse(const std::string& message) {
  throw Error(ErrorCode::InvalidArgument, message);
}

// Runs what may throw.
template <class F>
pierce_code guarded(pierce_error* error, const F& f) noexcept {
  try {
    f();
    return PIERCE_OK;
  } catch (const Error& e) {
    const auto code = static_cast<pierce_code>(1 + static_cast<int>(e.code()));
    return failed(error, code, e.what(), e.index(), e.count());
  } catch (const std::bad_alloc&) {
    return failed(error, PIERCE_OUT_OF_MEMORY, "not enough memory");
  } catch (const std::length_error&) {  // an array of more than there can be
    return failed(error, PIERCE_OUT_OF_MEMORY, "not enough memory: look at the counts");
  } catch (const std::exception& e) {
    return failed(error, PIERCE_UNEXPECTED, e.what());
  } catch (...) {
    return failed(error, PIERCE_UNEXPECTED, "something that is no exception was thrown");
  }
}

// An array that somebody gave us; `name` is how the header calls it.
template <class To, class From>
std::span<To> array(From* data, std::size_t count, const char* name) {
  if (data == nullptr && count != 0) refuse(std::string(name) + " is NULL: give an array");
  return {reinterpret_cast<To*>(data), count};
}

template <class To, class From>
std::span<const To> array_or_none(const From* data, std::size_t count) {
  return {reinterpret_cast<const To*>(data), data == nullptr ? 0 : count};
}

template <class T>
T& the(T* thing, const char* name) {
  if (thing == nullptr) refuse(std::string(name) + " is NULL");
  return *thing;
}

template <class Enum>
Enum choice(std::uint32_t number, std::uint32_t last, const char* name) {
  if (number > last)
    refuse(std::string(name) + " is " + std::to_string(number) + ": give 0 to " +
           std::to_string(last));
  return static_cast<Enum>(number);
}

// Options of a call; holds what they point to, so it outlives the call.
class Work {
 public:
  explicit Work(const pierce_work* given) {
    if (given == nullptr) return;
    options_.threads = given->threads;
    options_.statistics = reinterpret_cast<Statistics*>(given->statistics);
    if (given->progress == nullptr) return;
    options_.stop = &stop_;
    options_.progress = [this, given = *given](double fraction) {
      if (given.progress(given.progress_user, fraction) != 0) stop_ = true;
    };
  }
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;
  [[nodiscard]] const WorkOptions& options() const { return options_; }

 private:
  std::atomic<bool> stop_ = false;
  WorkOptions options_;
};

template <class T>
const pierce_work* work_of(const T* options) {
  return options == nullptr ? nullptr : &options->work;
}

BatchOptions batch_options(const pierce_query_options* given, std::size_t count, const Work& work) {
  BatchOptions options;
  options.work = work.options();
  if (given == nullptr) return options;
  options.range = given->open_start != 0 ? Range::OpenStart : Range::Closed;
  options.sides = choice<Sides>(given->sides, PIERCE_BACK, "sides");
  options.distinct = given->distinct != 0;
  options.invalid = given->invalid_miss != 0 ? InvalidRays::Miss : InvalidRays::Throw;
  if (given->mask != nullptr) options.mask = *given->mask;
  options.masks = array_or_none<std::uint32_t>(given->masks, count);
  options.skip = array_or_none<TriangleRef>(given->skip, count);
  options.after = array_or_none<TriangleRef>(given->after, count);
  if (given->max_hits != 0) options.max_hits = given->max_hits;
  if (given->filter != nullptr) {
    options.filter = [filter = given->filter, user = given->filter_user](std::uint64_t ray,
                                                                         const Hit<double>& hit) {
      return filter(user, ray, reinterpret_cast<const pierce_hit_f64*>(&hit)) != 0;
    };
  }
  return options;
}

LocateOptions locate_options(const pierce_point_options* given, const Work& work) {
  LocateOptions options;
  options.work = work.options();
  if (given == nullptr) return options;
  options.rule = given->non_zero != 0 ? InsideRule::NonZero : InsideRule::Odd;
  options.open_mesh = given->open_mesh != 0;
  return options;
}

template <class Real, class CMesh>
std::vector<MeshView<Real>> views_of(const CMesh* meshes, std::size_t count) {
  std::vector<MeshView<Real>> views;
  for (const CMesh& mesh : array<const CMesh>(meshes, count, "meshes")) {
    const auto vertices = array<const Vec3<Real>>(mesh.vertices, mesh.vertex_count, "vertices");
    const auto triangles = array<const Triangle>(mesh.triangles, mesh.triangle_count, "triangles");
    views.push_back({{vertices.data(), vertices.size()}, {triangles.data(), triangles.size()}});
  }
  return views;
}

template <class Real>
std::vector<Mesh<Real>> copies_of(std::span<const MeshView<Real>> views) {
  std::vector<Mesh<Real>> meshes;
  for (const MeshView<Real>& view : views) {
    meshes.push_back({{view.vertices.begin(), view.vertices.end()},
                      {view.triangles.begin(), view.triangles.end()}});
  }
  return meshes;
}

Quality quality_of(std::uint32_t number) {
  constexpr Quality kQualities[] = {Quality::Balanced, Quality::Fast, Quality::High,
                                    Quality::Compact};
  return kQualities[choice<std::uint32_t>(number, PIERCE_COMPACT, "quality")];
}

template <class Real, class CScene, class CMesh>
pierce_code build(const CMesh* meshes, std::size_t count, const pierce_build_options* given,
                  CScene** scene, pierce_error* error) noexcept {
  if (scene == nullptr) return failed(error, PIERCE_INVALID_ARGUMENT, "scene is NULL");
  *scene = nullptr;
  return guarded(error, [&] {
    const Work work(work_of(given));
    BuildOptions options;
    options.work = work.options();
    const bool views = given != nullptr && given->view_meshes != 0;
    if (given != nullptr) {
      options.quality = quality_of(given->quality);
      options.masks = array_or_none<std::uint32_t>(given->masks, count);
    }
    const std::vector<MeshView<Real>> all = views_of<Real>(meshes, count);
    const std::span<const MeshView<Real>> viewed(all);
    *scene = new CScene{views ? Scene<Real>::build(viewed, options)
                              : Scene<Real>::build(copies_of(viewed), options),
                        views};
  });
}

template <class Real, class CScene, class CMesh>
pierce_code refit(CScene* scene, const CMesh* meshes, std::size_t count, const pierce_work* given,
                  pierce_error* error) noexcept {
  return guarded(error, [&] {
    const Work work(given);
    const std::vector<MeshView<Real>> all = views_of<Real>(meshes, count);
    const std::span<const MeshView<Real>> viewed(all);
    CScene& s = the(scene, "scene");
    if (s.views) {
      s.scene.refit(viewed, work.options());
    } else {
      s.scene.refit(copies_of(viewed), work.options());
    }
  });
}

template <class CScene>
pierce_code info(const CScene* scene, pierce_scene_info* out, pierce_error* error) noexcept {
  return guarded(error, [&] {
    const SceneInfo i = the(scene, "scene").scene.info();
    the(out, "info") = {i.triangles, i.vertices, i.degenerate, i.nodes,
                        i.leaves,    i.sah_cost, i.bytes};
  });
}

// A batch of rays: ask(scene, rays, options).
template <class Real, class CScene, class CRay, class F>
pierce_code cast(const CScene* scene, const CRay* rays, std::size_t count,
                 const pierce_query_options* given, pierce_error* error, const F& ask) noexcept {
  return guarded(error, [&] {
    const Work work(work_of(given));
    const BatchOptions options = batch_options(given, count, work);
    ask(the(scene, "scene").scene, array<const Ray<Real>>(rays, count, "rays"), options);
  });
}

template <class Real, class CScene, class CRay, class Consume>
pierce_code all_hits(const CScene* scene, const CRay* rays, std::size_t count,
                     const pierce_query_options* given, Consume consume, void* user,
                     pierce_error* error) noexcept {
  using CHit = std::conditional_t<std::is_same_v<Real, float>, pierce_hit_f32, pierce_hit_f64>;
  return cast<Real>(
      scene, rays, count, given, error,
      [&](const auto& s, auto spans, const BatchOptions& options) {
        if (consume == nullptr) refuse("consume is NULL: give a function");
        s.all_hits(spans, options, [&](std::uint64_t first, const HitLists<Real>& lists) {
          const auto* hits = reinterpret_cast<const CHit*>(lists.hits.data());
          if (consume(user, first, lists.offsets.size() - 1, lists.offsets.data(), hits) != 0) {
            throw Error(ErrorCode::Stopped, "stopped by consume");
          }
        });
      });
}

template <class Real, class CScene, class CNearest>
pierce_code nearest(const CScene* scene, const Real* points, std::size_t count, Real radius,
                    const pierce_work* given, CNearest* out, pierce_error* error) noexcept {
  return guarded(error, [&] {
    const Work work(given);
    NearestOptions<Real> options;
    options.radius = radius;
    options.work = work.options();
    the(scene, "scene")
        .scene.nearest_points(array<const Vec3<Real>>(points, count, "points"),
                              array<NearestPoint<Real>>(out, count, "nearest"), options);
  });
}

}  // namespace

const char* pierce_code_name(pierce_code code) {
  if (code == PIERCE_OK) return "Ok";
  if (code >= PIERCE_NON_FINITE_VERTEX && code <= PIERCE_BAD_FILE)
    return name_of(static_cast<ErrorCode>(code - 1));
  if (code == PIERCE_OUT_OF_MEMORY) return "OutOfMemory";
  return code == PIERCE_UNEXPECTED ? "Unexpected" : "Unknown";
}

const char* pierce_version(void) { return kVersion; }

// Every function of the header, once for each type.
#define PIERCE_FUNCTIONS(kind, Real)                                                               \
  pierce_code pierce_build_##kind(const pierce_mesh_##kind* meshes, size_t count,                  \
                                  const pierce_build_options* options,                             \
                                  pierce_scene_##kind** scene, pierce_error* error) {              \
    return build<Real>(meshes, count, options, scene, error);                                      \
  }                                                                                                \
  void pierce_free_##kind(pierce_scene_##kind* scene) { delete scene; }                            \
  pierce_code pierce_refit_##kind(pierce_scene_##kind* scene, const pierce_mesh_##kind* meshes,    \
                                  size_t count, const pierce_work* work, pierce_error* error) {    \
    return refit<Real>(scene, meshes, count, work, error);                                         \
  }                                                                                                \
  pierce_code pierce_info_##kind(const pierce_scene_##kind* scene, pierce_scene_info* out,         \
                                 pierce_error* error) {                                            \
    return info(scene, out, error);                                                                \
  }                                                                                                \
  pierce_code pierce_closest_hits_##kind(                                                          \
      const pierce_scene_##kind* scene, const pierce_ray_##kind* rays, size_t count,               \
      const pierce_query_options* options, pierce_hit_##kind* hits, pierce_error* error) {         \
    return cast<Real>(scene, rays, count, options, error, [&](auto& s, auto r, auto& o) {          \
      s.closest_hits(r, array<Hit<Real>>(hits, count, "hits"), o);                                 \
    });                                                                                            \
  }                                                                                                \
  pierce_code pierce_any_hits_##kind(                                                              \
      const pierce_scene_##kind* scene, const pierce_ray_##kind* rays, size_t count,               \
      const pierce_query_options* options, uint8_t* any, pierce_error* error) {                    \
    return cast<Real>(scene, rays, count, options, error, [&](auto& s, auto r, auto& o) {          \
      s.any_hits(r, array<std::uint8_t>(any, count, "any"), o);                                    \
    });                                                                                            \
  }                                                                                                \
  pierce_code pierce_count_hits_##kind(                                                            \
      const pierce_scene_##kind* scene, const pierce_ray_##kind* rays, size_t count,               \
      const pierce_query_options* options, uint32_t* counts, pierce_error* error) {                \
    return cast<Real>(scene, rays, count, options, error, [&](auto& s, auto r, auto& o) {          \
      s.count_hits(r, array<std::uint32_t>(counts, count, "counts"), o);                           \
    });                                                                                            \
  }                                                                                                \
  pierce_code pierce_all_hits_##kind(                                                              \
      const pierce_scene_##kind* scene, const pierce_ray_##kind* rays, size_t count,               \
      const pierce_query_options* options, pierce_consume_##kind consume, void* user,              \
      pierce_error* error) {                                                                       \
    return all_hits<Real>(scene, rays, count, options, consume, user, error);                      \
  }                                                                                                \
  pierce_code pierce_crossings_##kind(                                                             \
      const pierce_scene_##kind* scene, const pierce_ray_##kind* rays, size_t count,               \
      const pierce_query_options* options, pierce_crossings* crossings, pierce_error* error) {     \
    return cast<Real>(scene, rays, count, options, error, [&](auto& s, auto r, auto& o) {          \
      s.crossings(r, array<Crossings>(crossings, count, "crossings"), o);                          \
    });                                                                                            \
  }                                                                                                \
  pierce_code pierce_locate_##kind(const pierce_scene_##kind* scene, const Real* points,           \
                                   size_t count, const pierce_point_options* options,              \
                                   int8_t* locations, pierce_error* error) {                       \
    return guarded(error, [&] {                                                                    \
      const Work work(work_of(options));                                                           \
      the(scene, "scene")                                                                          \
          .scene.locate(array<const Vec3<Real>>(points, count, "points"),                          \
                        array<Location>(locations, count, "locations"),                            \
                        locate_options(options, work));                                            \
    });                                                                                            \
  }                                                                                                \
  pierce_code pierce_nearest_points_##kind(const pierce_scene_##kind* scene, const Real* points,   \
                                           size_t count, Real radius, const pierce_work* work,     \
                                           pierce_nearest_##kind* out, pierce_error* error) {      \
    return nearest<Real>(scene, points, count, radius, work, out, error);                          \
  }                                                                                                \
  pierce_code pierce_signed_distances_##kind(const pierce_scene_##kind* scene, const Real* points, \
                                             size_t count, const pierce_point_options* options,    \
                                             Real* distances, pierce_error* error) {               \
    return guarded(error, [&] {                                                                    \
      const Work work(work_of(options));                                                           \
      the(scene, "scene")                                                                          \
          .scene.signed_distances(array<const Vec3<Real>>(points, count, "points"),                \
                                  array<Real>(distances, count, "distances"),                      \
                                  locate_options(options, work));                                  \
    });                                                                                            \
  }

PIERCE_FUNCTIONS(f32, float)
PIERCE_FUNCTIONS(f64, double)
