// SPDX-License-Identifier: Apache-2.0
#include "wasm.h"

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <vector>

#include "pierce/intersect.h"
#include "pierce/textbook.h"
#include "pierce/textbook/methods.h"

namespace {

template <class CHit>
struct Gathered {
  std::vector<std::uint32_t> offsets = {0};
  std::vector<CHit> hits;

  static int consume(void* user, std::uint64_t, std::size_t count, const std::uint64_t* offsets,
                     const CHit* hits) {
    auto& self = *static_cast<Gathered*>(user);
    const auto before = static_cast<std::uint32_t>(self.hits.size());
    for (std::size_t i = 1; i <= count; ++i)
      self.offsets.push_back(before + static_cast<std::uint32_t>(offsets[i]));
    self.hits.insert(self.hits.end(), hits, hits + offsets[count]);
    return 0;
  }

  void* in_one_piece() const {
    const std::size_t head = (offsets.size() * sizeof offsets[0] + 7) & ~std::size_t{7};
    auto* memory = static_cast<char*>(std::malloc(head + hits.size() * sizeof(CHit)));
    if (memory == nullptr) return nullptr;
    std::memcpy(memory, offsets.data(), offsets.size() * sizeof offsets[0]);
    if (!hits.empty()) std::memcpy(memory + head, hits.data(), hits.size() * sizeof(CHit));
    return memory;
  }
};

template <class Real, class CRay>
int textbook(std::uint32_t method, const CRay* rays, const Real* triangles, std::size_t count,
             Real* answers) {
  constexpr auto kMethods = pierce::textbook::methods<Real>();
  if (method != UINT32_MAX && method >= kMethods.size()) return 1;
  const auto* corners = reinterpret_cast<const pierce::Vec3<Real>*>(triangles);
  for (std::size_t i = 0; i < count; ++i, corners += 3, answers += 4) {
    const auto& ray = reinterpret_cast<const pierce::Ray<Real>&>(rays[i]);
    for (int j = 0; j < 4; ++j) answers[j] = 0;
    if (method == UINT32_MAX) {
      const auto hit = pierce::intersect(ray, corners[0], corners[1], corners[2]);
      if (hit) answers[0] = 1, answers[1] = hit->t, answers[2] = hit->u, answers[3] = hit->v;
    } else {
      const auto hit = kMethods[method].test(ray, corners[0], corners[1], corners[2]);
      if (hit) answers[0] = 1, answers[1] = hit->t, answers[2] = hit->u, answers[3] = hit->v;
    }
  }
  return 0;
}

}  // namespace

std::uint32_t pierce_size(std::uint32_t which) {
  constexpr std::size_t kSizes[] = {sizeof(pierce_error), sizeof(pierce_query_options),
                                    sizeof(pierce_point_options)};
  return which < 3 ? static_cast<std::uint32_t>(kSizes[which]) : 0;
}

void* pierce_gather_f32(const pierce_scene_f32* scene, const pierce_ray_f32* rays, size_t count,
                        const pierce_query_options* options, pierce_error* error) {
  Gathered<pierce_hit_f32> all;
  const auto code = pierce_all_hits_f32(scene, rays, count, options, all.consume, &all, error);
  return code == PIERCE_OK ? all.in_one_piece() : nullptr;
}

void* pierce_gather_f64(const pierce_scene_f64* scene, const pierce_ray_f64* rays, size_t count,
                        const pierce_query_options* options, pierce_error* error) {
  Gathered<pierce_hit_f64> all;
  const auto code = pierce_all_hits_f64(scene, rays, count, options, all.consume, &all, error);
  return code == PIERCE_OK ? all.in_one_piece() : nullptr;
}

const char* pierce_method_name(std::uint32_t method) {
  constexpr auto kMethods = pierce::textbook::methods<float>();
  return method < kMethods.size() ? kMethods[method].name.data() : nullptr;
}

int pierce_textbook_f32(std::uint32_t method, const pierce_ray_f32* rays, const float* triangles,
                        size_t count, float* answers) {
  return textbook(method, rays, triangles, count, answers);
}

int pierce_textbook_f64(std::uint32_t method, const pierce_ray_f64* rays, const double* triangles,
                        size_t count, double* answers) {
  return textbook(method, rays, triangles, count, answers);
}
