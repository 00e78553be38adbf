// SPDX-License-Identifier: Apache-2.0
//
// The textbook: Moeller-Trumbore on every triangle, in float with an epsilon of 0, edges at hand.
// What a first program does; here to show what a tree is worth. Small meshes, few rays.
#include <chrono>
#include <limits>

#include "contenders/families.h"
#include "contenders/parallel.h"
#include "contenders/ray_by_ray.h"
#include "pierce/textbook/moller_trumbore.h"

namespace pierce::bench {
namespace {

class TextbookEngine : public Engine {
 public:
  using Engine::Engine;

  BuildFigures build(const Mesh& mesh, unsigned /*threads*/) override {
    mesh_ = &mesh;
    return {};
  }
  void release() override { mesh_ = nullptr; }
  [[nodiscard]] std::uint64_t most_triangles() const override { return 600'000; }
  [[nodiscard]] const Mesh& mesh() const { return *mesh_; }

 private:
  const Mesh* mesh_ = nullptr;
};

class TextbookContender : public RayByRay<float> {
 public:
  TextbookContender(std::string name, TextbookEngine& engine)
      : RayByRay(std::move(name), engine), textbook_(engine) {}

  [[nodiscard]] std::size_t most_rays() const override { return 64; }

  void run() override {
    in_chunks(rays_.size(), threads_, [this](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) query_ == Query::Closest ? closest(i) : any(i);
    });
  }

 private:
  void closest(std::size_t i) {
    const Mesh& mesh = textbook_.mesh();
    Ray<float> ray = rays_[i];
    Hit<float> best;
    for (std::uint32_t k = 0; k < mesh.triangles.size(); ++k) {
      const auto& [a, b, c] = mesh.triangles[k];
      const auto hit =
          textbook::moller_trumbore(ray, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], 0);
      if (!hit || hit->t >= best.t) continue;
      best = {hit->t, hit->u, hit->v, 1 - hit->u - hit->v, 0, k, Facing::Front};
      ray.t_max = hit->t;
    }
    hits_[i] = best;
  }

  void any(std::size_t i) {
    const Mesh& mesh = textbook_.mesh();
    any_[i] = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
      if (textbook::moller_trumbore(rays_[i], mesh.vertices[a], mesh.vertices[b], mesh.vertices[c],
                                    0)) {
        any_[i] = 1;
        return;
      }
    }
  }

  TextbookEngine& textbook_;
};

}  // namespace

bool add_textbook(Field& field, const std::string& name) {
  if (name != "textbook") return false;
  auto& engine = shared_engine<TextbookEngine>(field, name);
  field.contenders.push_back(std::make_unique<TextbookContender>(name, engine));
  return true;
}

}  // namespace pierce::bench
