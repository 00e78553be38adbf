// SPDX-License-Identifier: Apache-2.0
//
// Cases as text: words and numbers in a fixed order, floats in hexadecimal.
#include <cstdlib>
#include <istream>
#include <ostream>
#include <stdexcept>

#include "campaign/case.h"

namespace pierce::campaign {
namespace {

template <class Real>
void put(std::ostream& out, const Vec3<Real>& p) {
  out << double{p.x} << ' ' << double{p.y} << ' ' << double{p.z} << '\n';
}

std::string word(std::istream& in) {
  std::string text;
  if (!(in >> text)) throw std::runtime_error("the case ends too early");
  return text;
}

void expect(std::istream& in, const std::string& wanted) {
  const std::string found = word(in);
  if (found != wanted)
    throw std::runtime_error("'" + found + "' stands where '" + wanted + "' should");
}

std::uint64_t whole(std::istream& in) { return std::stoull(word(in)); }

std::uint32_t index(std::istream& in) { return static_cast<std::uint32_t>(whole(in)); }

template <class Real>
Real number(std::istream& in) {
  return static_cast<Real>(std::strtod(word(in).c_str(), nullptr));
}

template <class Real>
Vec3<Real> vector(std::istream& in) {
  const Real x = number<Real>(in), y = number<Real>(in), z = number<Real>(in);
  return {x, y, z};
}

template <class Real>
void save_limits(std::ostream& out, const Case<Real>& made) {
  out << "sides " << int(made.sides) << " mask " << made.mask << " hits " << made.max_hits;
  for (const auto* masks : {&made.geometry_masks, &made.ray_masks}) {
    out << "\nmasks " << masks->size();
    for (const auto mask : *masks) out << ' ' << mask;
  }
  out << '\n';
}

template <class Real>
void save_meshes(std::ostream& out, const char* name, const std::vector<Mesh<Real>>& meshes) {
  out << name << ' ' << meshes.size() << '\n';
  for (const auto& mesh : meshes) {
    out << mesh.vertices.size() << ' ' << mesh.triangles.size() << '\n';
    for (const auto& v : mesh.vertices) put(out, v);
    for (const auto& t : mesh.triangles) out << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  }
}

template <class Real>
void save_origin(std::ostream& out, const Origin<Real>& origin) {
  save_meshes(out, "before", origin.before);
  save_meshes(out, "sources", origin.sources);
  out << "in_place " << origin.in_place << " later " << origin.placed_later << " placements "
      << origin.placements.size() << '\n';
  for (const auto& [mesh, transform] : origin.placements) {
    out << mesh;
    for (const auto& row : transform.rows) {
      for (const Real m : row) out << ' ' << double{m};
    }
    out << '\n';
  }
}

template <class Real>
void save(std::ostream& out, const Case<Real>& made) {
  out << "campaign 2 " << (sizeof(Real) == 4 ? "float" : "double") << '\n' << made.name << '\n';
  out << "range " << int(made.range) << " rule " << int(made.rule) << " open " << made.open_mesh
      << " threads " << made.build_threads << "\nqualities " << made.qualities.size();
  for (const auto quality : made.qualities) out << ' ' << int(quality);
  out << '\n' << std::hexfloat;
  save_meshes(out, "meshes", made.meshes);
  save_origin(out, made.origin);
  out << "rays " << made.rays.size() << '\n';
  for (const auto& ray : made.rays) {
    put(out, ray.origin);
    put(out, ray.direction);
    out << double{ray.t_min} << ' ' << double{ray.t_max} << '\n';
  }
  out << "skip " << made.skip.size() << '\n';
  for (const auto& ref : made.skip) out << ref.geometry << ' ' << ref.triangle << '\n';
  save_limits(out, made);
  out << "points " << made.points.size() << '\n';
  for (std::size_t i = 0; i < made.points.size(); ++i) {
    out << double{made.radii[i]} << ' ';
    put(out, made.points[i]);
  }
  out << "cells " << made.cells.has_value() << '\n';
  if (!made.cells) return;
  const auto& [grid, first, layers] = *made.cells;
  put(out, grid.origin);
  put(out, grid.spacing);
  out << grid.size[0] << ' ' << grid.size[1] << ' ' << grid.size[2] << ' ' << first << ' ' << layers
      << '\n';
}

template <class Real>
std::vector<Mesh<Real>> load_meshes(std::istream& in, const char* name) {
  expect(in, name);
  std::vector<Mesh<Real>> meshes(whole(in));
  for (auto& mesh : meshes) {
    mesh.vertices.resize(whole(in));
    mesh.triangles.resize(whole(in));
    for (auto& v : mesh.vertices) v = vector<Real>(in);
    for (auto& t : mesh.triangles) {
      for (auto& corner : t) corner = index(in);
    }
  }
  return meshes;
}

template <class Real>
Origin<Real> load_origin(std::istream& in) {
  Origin<Real> origin;
  origin.before = load_meshes<Real>(in, "before");
  origin.sources = load_meshes<Real>(in, "sources");
  expect(in, "in_place");
  origin.in_place = whole(in) != 0;
  expect(in, "later");
  origin.placed_later = whole(in) != 0;
  expect(in, "placements");
  origin.placements.resize(whole(in));
  for (auto& [mesh, transform] : origin.placements) {
    mesh = whole(in);
    for (auto& row : transform.rows) {
      for (auto& m : row) m = number<Real>(in);
    }
  }
  return origin;
}

template <class Real>
void load_limits(std::istream& in, Case<Real>& made) {
  expect(in, "sides");
  made.sides = static_cast<Sides>(whole(in));
  expect(in, "mask");
  made.mask = index(in);
  expect(in, "hits");
  made.max_hits = whole(in);
  for (auto* masks : {&made.geometry_masks, &made.ray_masks}) {
    expect(in, "masks");
    masks->resize(whole(in));
    for (auto& mask : *masks) mask = index(in);
  }
}

template <class Real>
void load_questions(std::istream& in, Case<Real>& made) {
  expect(in, "rays");
  made.rays.resize(whole(in));
  for (auto& ray : made.rays) {
    ray.origin = vector<Real>(in);
    ray.direction = vector<Real>(in);
    ray.t_min = number<Real>(in);
    ray.t_max = number<Real>(in);
  }
  expect(in, "skip");
  made.skip.resize(whole(in));
  for (auto& ref : made.skip) ref.geometry = index(in), ref.triangle = index(in);
  load_limits(in, made);
  expect(in, "points");
  for (std::uint64_t left = whole(in); left > 0; --left) {
    made.radii.push_back(number<Real>(in));
    made.points.push_back(vector<Real>(in));
  }
  expect(in, "cells");
  if (whole(in) == 0) return;
  Cells<Real> cells;
  cells.grid.origin = vector<Real>(in);
  cells.grid.spacing = vector<Real>(in);
  for (auto& n : cells.grid.size) n = index(in);
  cells.first = index(in);
  cells.layers = index(in);
  made.cells = cells;
}

template <class Real>
Case<Real> load(std::istream& in) {
  Case<Real> made;
  std::getline(in >> std::ws, made.name);
  expect(in, "range");
  made.range = static_cast<Range>(whole(in));
  expect(in, "rule");
  made.rule = static_cast<InsideRule>(whole(in));
  expect(in, "open");
  made.open_mesh = whole(in) != 0;
  expect(in, "threads");
  made.build_threads = index(in);
  expect(in, "qualities");
  for (std::uint64_t left = whole(in); left > 0; --left) {
    made.qualities.push_back(static_cast<Quality>(whole(in)));
  }
  made.meshes = load_meshes<Real>(in, "meshes");
  made.origin = load_origin<Real>(in);
  load_questions(in, made);
  return made;
}

}  // namespace

void save_case(std::ostream& out, const AnyCase& any) {
  std::visit([&](const auto& made) { save(out, made); }, any);
}

AnyCase load_case(std::istream& in) {
  expect(in, "campaign");
  expect(in, "2");
  if (word(in) == "float") return load<float>(in);
  return load<double>(in);
}

}  // namespace pierce::campaign
