// SPDX-License-Identifier: Apache-2.0
//
// pierce cast --ray: the answers in words. One hit a line.
#include <span>
#include <string>
#include <vector>

#include "answer_printer.h"
#include "cast_options.h"
#include "support/count_words.h"
#include "words.h"

namespace pierce::tool {
namespace {

template <class Real>
class Answerer {
 public:
  Answerer(const CastOptions& options, const LoadedScene<Real>& mesh,
           std::span<const Ray<Real>> rays)
      : mesh_(mesh),
        rays_(rays),
        batch_(batch_options(options)),
        printer_(options.json, begin(options), "ray", rays.size()) {}

  void closest() {
    std::vector<Hit<Real>> hits(rays_.size());
    mesh_.scene().closest_hits(rays_, hits, batch_);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      printer_.answer([&](auto line) { line(words(hits[i], i)); },
                      [&](io::JsonWriter& json) { add(json, hits[i], i); });
    }
  }

  void any() {
    std::vector<std::uint8_t> hits(rays_.size());
    mesh_.scene().any_hits(rays_, hits, batch_);
    for (const std::uint8_t hit : hits) {
      printer_.answer([&](auto line) { line(hit != 0 ? "hits" : "misses"); },
                      [&](io::JsonWriter& json) { json.value("hit", hit != 0); });
    }
  }

  void all() {
    const HitLists<Real> lists = mesh_.scene().all_hits(rays_, batch_);
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      printer_.answer(
          [&](auto line) {
            for (const Hit<Real>& hit : lists.of(i)) line(words(hit, i));
            if (lists.of(i).empty()) line("misses");
          },
          [&](io::JsonWriter& json) {
            json.open_array("hits");
            for (const Hit<Real>& hit : lists.of(i)) {
              json.open_object();
              add(json, hit, i);
              json.close_object();
            }
            json.close_array();
          });
    }
  }

  void count() {
    std::vector<std::uint32_t> counts(rays_.size());
    mesh_.scene().count_hits(rays_, counts, batch_);
    for (const std::uint32_t n : counts) {
      printer_.answer([&](auto line) { line(counted(n, "hit", "hits")); },
                      [&](io::JsonWriter& json) { json.value("count", n); });
    }
  }

  void crossings() {
    std::vector<Crossings> all(rays_.size());
    mesh_.scene().crossings(rays_, all, batch_);
    for (const Crossings& one : all) {
      printer_.answer([&](auto line) { line(to_words(one)); },
                      [&](io::JsonWriter& json) { add_answer(json, one); });
    }
  }

  void finish() { printer_.finish(); }

 private:
  [[nodiscard]] io::JsonWriter begin(const CastOptions& options) const {
    io::JsonWriter json = begin_json("cast", options, mesh_);
    json.value("query", name_of(options.query));
    return json;
  }
  [[nodiscard]] Feature feature(const Hit<Real>& hit, std::size_t ray) const {
    if (hit.triangle == kNone) return Feature::Face;
    (void)mesh_.scene().normal(hit);  // of a damaged scene file refuses the triangle
    return hit_feature(hit, rays_[ray], mesh_.scene().meshes()[hit.geometry]);
  }
  [[nodiscard]] std::string words(const Hit<Real>& hit, std::size_t ray) const {
    return to_words(hit, feature(hit, ray));
  }
  void add(io::JsonWriter& json, const Hit<Real>& hit, std::size_t ray) const {
    add_answer(json, hit, feature(hit, ray));
  }

  const LoadedScene<Real>& mesh_;
  std::span<const Ray<Real>> rays_;
  BatchOptions batch_;
  AnswerPrinter printer_;
};

}  // namespace

template <class Real>
void print_answers(const CastOptions& options, const LoadedScene<Real>& mesh,
                   const io::RayFile& file) {
  std::vector<Ray<Real>> rays(file.size());
  file.read(0, std::span(rays));
  Answerer<Real> answerer(options, mesh, rays);
  naming_rays<Real>(file.name(), 0, mesh.scene(), rays, [&] {
    switch (options.query) {
      case Query::Closest:
        return answerer.closest();
      case Query::Any:
        return answerer.any();
      case Query::All:
        return answerer.all();
      case Query::Count:
        return answerer.count();
      case Query::Crossings:
        return answerer.crossings();
    }
  });
  answerer.finish();
}

template void print_answers(const CastOptions&, const LoadedScene<float>&, const io::RayFile&);
template void print_answers(const CastOptions&, const LoadedScene<double>&, const io::RayFile&);

}  // namespace pierce::tool
