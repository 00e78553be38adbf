// SPDX-License-Identifier: Apache-2.0
//
// Reads tests/regression/data/bug_gallery.json: famous failures of other ray casters with their
// exact answers. Every number in it is a hex float in quotes, so nothing is rounded on the way.
#pragma once

#include <algorithm>
#include <array>
#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "pierce/types.h"

namespace pierce::gallery {

struct ClosedHit {
  std::uint32_t triangle;
  std::string feature;
  double t_f64, u_f64, v_f64, t_f32;
};

struct GalleryRay {
  Vec3<double> origin, direction;
  std::vector<ClosedHit> hits;
  std::vector<std::uint32_t> coplanar;
  std::uint32_t distinct_t;
};

struct GalleryCase {
  std::string name;
  bool is_float;  // every input number is a float
  std::vector<Vec3<double>> vertices;
  std::vector<Triangle> triangles;
  std::vector<GalleryRay> rays;
};

namespace detail {

using Tree = boost::property_tree::ptree;

inline double number(const Tree& tree) {
  const std::string text = tree.data();
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0') throw std::runtime_error("gallery: not a number: " + text);
  return value;
}

inline std::vector<double> numbers(const Tree& tree) {
  std::vector<double> values;
  for (const auto& [key, child] : tree) values.push_back(number(child));
  return values;
}

inline std::vector<std::uint32_t> indices(const Tree& tree) {
  std::vector<std::uint32_t> values;
  for (const auto& [key, child] : tree) values.push_back(child.get_value<std::uint32_t>());
  return values;
}

inline Vec3<double> vec(const Tree& tree) {
  const auto v = numbers(tree);
  return {v.at(0), v.at(1), v.at(2)};
}

}  // namespace detail

inline std::vector<GalleryCase> read_gallery(const std::string& path) {
  detail::Tree root;
  boost::property_tree::read_json(path, root);
  std::vector<GalleryCase> cases;
  for (const auto& [key, tree] : root) {
    GalleryCase gallery_case{tree.get<std::string>("name"),
                             tree.get<std::string>("input_precision") == "f32",
                             {},
                             {},
                             {}};
    for (const auto& [k, v] : tree.get_child("vertices")) {
      gallery_case.vertices.push_back(detail::vec(v));
    }
    for (const auto& [k, f] : tree.get_child("faces")) {
      const auto face = detail::indices(f);
      gallery_case.triangles.push_back({face.at(0), face.at(1), face.at(2)});
    }
    for (const auto& [k, r] : tree.get_child("rays")) {
      GalleryRay ray{detail::vec(r.get_child("org")),
                     detail::vec(r.get_child("dir")),
                     {},
                     detail::indices(r.get_child("coplanar_tris")),
                     r.get<std::uint32_t>("distinct_t")};
      for (const auto& [j, h] : r.get_child("exact_closed_hits")) {
        ray.hits.push_back(
            {h.get<std::uint32_t>("tri"), h.get<std::string>("feature"),
             detail::number(h.get_child("t_f64")), detail::number(h.get_child("u_f64")),
             detail::number(h.get_child("v_f64")), detail::number(h.get_child("t_f32"))});
      }
      gallery_case.rays.push_back(std::move(ray));
    }
    cases.push_back(std::move(gallery_case));
  }
  return cases;
}

}  // namespace pierce::gallery
