// SPDX-License-Identifier: Apache-2.0
//
#include "textbook.h"

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <string>
#include <vector>

#include "buffer.h"
#include "pierce/textbook.h"
#include "run.h"

namespace pierce::python {
namespace {

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto& method : textbook::methods<double>()) names.emplace_back(method.name);
  return names;
}

// `pair`: origins, directions (n, 3), t_min, t_max (n,), corners a, b, c (n, 3). Fills `hits` (n,)
// uint8 and, where there is a hit, `numbers` (n, 3): t, u, v.
template <class Real>
void textbook_of(std::size_t number, const nb::tuple& pair, nb::handle hits, nb::handle numbers) {
  const auto methods = textbook::methods<Real>();
  const auto& method = methods.at(number);
  const Buffer origins(pair[0], "origins"), directions(pair[1], "directions");
  const Buffer t_min(pair[2], "t_min"), t_max(pair[3], "t_max");
  const Buffer a(pair[4], "a"), b(pair[5], "b"), c(pair[6], "c");
  const Buffer out_hits(hits, "hits", Access::Write), out(numbers, "numbers", Access::Write);

  const auto from = origins.packed<const Vec3<Real>, const Real>(3);
  const auto along = directions.packed<const Vec3<Real>, const Real>(3);
  const auto low = t_min.packed<const Real, const Real>();
  const auto high = t_max.packed<const Real, const Real>();
  const auto as = a.packed<const Vec3<Real>, const Real>(3);
  const auto bs = b.packed<const Vec3<Real>, const Real>(3);
  const auto cs = c.packed<const Vec3<Real>, const Real>(3);
  const auto hit_flags = out_hits.packed<std::uint8_t, std::uint8_t>();
  const auto results = out.packed<Vec3<Real>, Real>(3);
  for (const std::size_t size : {along.size(), low.size(), high.size(), as.size(), bs.size(),
                                 cs.size(), hit_flags.size(), results.size()}) {
    if (size != from.size()) throw nb::value_error("textbook: arrays of different lengths");
  }

  run({}, from.size() > 10'000 ? Length::Long : Length::Brief, [&](const WorkOptions& work) {
    for (std::size_t i = 0; i < from.size(); ++i) {
      if (i % 4096 == 0 && work.stop != nullptr && *work.stop) return;
      const Ray<Real> ray{from[i], along[i], low[i], high[i]};
      const auto hit = method.test(ray, as[i], bs[i], cs[i]);
      hit_flags[i] = hit.has_value() ? 1 : 0;
      if (hit) results[i] = {hit->t, hit->u, hit->v};
    }
  });
}

}  // namespace

void add_textbook(nb::module_& module) {
  module.def("textbook_methods", &method_names);
  module.def("textbook_float", &textbook_of<float>);
  module.def("textbook_double", &textbook_of<double>);
}

}  // namespace pierce::python
