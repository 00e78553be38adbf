// SPDX-License-Identifier: Apache-2.0
//
// Particle transport without lost particles. Particles walk at random through nested and touching
// closed volumes, crossing by crossing; which volumes each one is in is tracked by what it crosses,
// and after every step compared with where its position exactly is. Radiation codes lose particles
// on geometry like this: at edges and vertices, on faces that coincide, near corners.
//
//   transport [--crossings N] [--seed S] [--threads T] [--mesh FILE.obj]
//
// Exits with 1 if a particle was lost or in a volume that it was not in.
#include <pierce/pierce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace {

using Real = float;
using Point = pierce::Vec3<Real>;
using Ray = pierce::Ray<Real>;
using Hit = pierce::Hit<Real>;
using Scene = pierce::Scene<Real>;
using pierce::Side;

// ------------------------------------------------------------------------------------

struct Mesh {
  std::vector<Point> vertices;
  std::vector<pierce::Triangle> triangles;
  [[nodiscard]] pierce::MeshView<Real> view() const { return {vertices, triangles}; }
};

// A box, outward, two triangles a face.
Mesh box(const Point& lower, const Point& upper) {
  Mesh mesh;
  for (unsigned i = 0; i < 8; ++i) {
    mesh.vertices.push_back({(i & 1U) != 0 ? upper.x : lower.x, (i & 2U) != 0 ? upper.y : lower.y,
                             (i & 4U) != 0 ? upper.z : lower.z});
  }
  mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return mesh;
}

// A ball with poles, outward.
Mesh ball(Real radius, std::uint32_t bands) {
  Mesh mesh;
  const std::uint32_t around = 2 * bands;
  const auto at = [&](std::uint32_t band, std::uint32_t turn) {
    return 1 + (band - 1) * around + turn % around;
  };
  mesh.vertices.push_back({0, 0, radius});
  for (std::uint32_t band = 1; band < bands; ++band) {
    const double a = 3.141592653589793 * band / bands;
    for (std::uint32_t turn = 0; turn < around; ++turn) {
      const double b = 3.141592653589793 * turn / bands;
      mesh.vertices.push_back(
          {static_cast<Real>(static_cast<double>(radius) * std::sin(a) * std::cos(b)),
           static_cast<Real>(static_cast<double>(radius) * std::sin(a) * std::sin(b)),
           static_cast<Real>(static_cast<double>(radius) * std::cos(a))});
    }
  }
  mesh.vertices.push_back({0, 0, -radius});
  const auto south = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (std::uint32_t turn = 0; turn < around; ++turn) {
    mesh.triangles.push_back({0, at(1, turn), at(1, turn + 1)});
    for (std::uint32_t band = 1; band + 1 < bands; ++band) {
      mesh.triangles.push_back({at(band, turn), at(band + 1, turn), at(band + 1, turn + 1)});
      mesh.triangles.push_back({at(band, turn), at(band + 1, turn + 1), at(band, turn + 1)});
    }
    mesh.triangles.push_back({at(bands - 1, turn), south, at(bands - 1, turn + 1)});
  }
  return mesh;
}

// The vertices and the faces (fanned) of an OBJ file; positive indices only.
std::optional<Mesh> read_obj(const std::string& path) {
  std::ifstream file(path);
  if (!file) return std::nullopt;
  Mesh mesh;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      Point p{};
      words >> p.x >> p.y >> p.z;
      mesh.vertices.push_back(p);
    } else if (kind == "f") {
      std::vector<std::uint32_t> ring;
      for (std::string corner; words >> corner;) {
        ring.push_back(static_cast<std::uint32_t>(std::stoul(corner)) - 1);
      }
      for (std::size_t i = 2; i < ring.size(); ++i) {
        mesh.triangles.push_back({ring[0], ring[i - 1], ring[i]});
      }
    }
  }
  return mesh;
}

// A world is closed volumes; they may lie within each other and share faces. Volume 0 is the wall:
// around all others, and nothing leaves it.
struct World {
  std::string name;
  std::vector<Mesh> volumes;
  std::optional<Scene> all;     // geometry i is volume i
  std::vector<Scene> each;      // volume i alone: to locate in, and to count passages through
  std::vector<Point> vertices;  // to aim at

  World(std::string world_name, std::vector<Mesh> meshes)
      : name(std::move(world_name)), volumes(std::move(meshes)) {
    std::vector<pierce::MeshView<Real>> views;
    for (const Mesh& mesh : volumes) {
      views.push_back(mesh.view());
      each.push_back(Scene::build(mesh.view()));
      vertices.insert(vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    }
    all.emplace(Scene::build(views));
  }
};

World shells() {
  return {"shells", {box({-3, -3, -3}, {3, 3, 3}), ball(2, 24), ball(1.5F, 16), ball(1, 12)}};
}

// 64 cubes with all their inner faces in common.
World packed_cubes() {
  std::vector<Mesh> volumes{box({-1, -1, -1}, {5, 5, 5})};
  for (int i = 0; i < 64; ++i) {
    const Point corner{static_cast<Real>(i % 4), static_cast<Real>(i / 4 % 4),
                       static_cast<Real>(i / 16)};
    volumes.push_back(box(corner, {corner.x + 1, corner.y + 1, corner.z + 1}));
  }
  return {"packed cubes", std::move(volumes)};
}

std::optional<World> mesh_in_a_box(const std::string& path) {
  std::optional<Mesh> mesh = read_obj(path);
  if (!mesh) return std::nullopt;
  Point lower = mesh->vertices.at(0), upper = lower;
  for (const Point& p : mesh->vertices) {
    lower = {std::min(lower.x, p.x), std::min(lower.y, p.y), std::min(lower.z, p.z)};
    upper = {std::max(upper.x, p.x), std::max(upper.y, p.y), std::max(upper.z, p.z)};
  }
  const Real far = upper.x - lower.x;
  Mesh around = box(lower, upper);  // touches the mesh where it is widest
  Mesh wall = box({lower.x - far, lower.y - far, lower.z - far},
                  {upper.x + far, upper.y + far, upper.z + far});
  return World("mesh in a box", {std::move(wall), std::move(around), std::move(*mesh)});
}

struct Tally {
  std::uint64_t crossings = 0, reflections = 0, lost = 0, misplaced = 0, squeezed = 0;
  Tally& operator+=(const Tally& other) {
    crossings += other.crossings;
    reflections += other.reflections;
    lost += other.lost;
    misplaced += other.misplaced;
    squeezed += other.squeezed;
    return *this;
  }
};

class Particle {
 public:
  Particle(const World& world, std::uint64_t seed)
      : world_(world), random_(seed), in_(world.each.size()) {
    do {  // anywhere within the wall, but on no surface
      const auto wall = world.volumes[0].view().vertices;
      const auto between = [&](Real low, Real high) { return low + unit() * (high - low); };
      at_ = {between(wall[0].x, wall[7].x), between(wall[0].y, wall[7].y),
             between(wall[0].z, wall[7].z)};
    } while (std::any_of(world.each.begin(), world.each.end(), [&](const Scene& volume) {
      return volume.locate(at_) == pierce::Location::OnSurface;
    }));
    for (std::size_t i = 0; i < in_.size(); ++i) {
      in_[i] = world.each[i].locate(at_) == pierce::Location::Inside;
    }
    turn();
  }

  // Flies until it has crossed `crossings` surfaces.
  Tally fly(std::uint64_t crossings) {
    while (tally_.crossings < crossings && tally_.lost == 0) {
      step();
      for (std::size_t i = 0; i < in_.size(); ++i) {
        const auto expected = in_[i] ? pierce::Location::Inside : pierce::Location::Outside;
        if (world_.each[i].locate(at_) == expected) continue;
        ++tally_.misplaced;
        return tally_;
      }
    }
    return tally_;
  }

 private:
  // To the next surface, and through it, or back from it.
  void step() {
    const Ray ray{at_, direction_};
    world_.all->all_hits(ray, hits_);
    const std::vector<bool> started_in = in_;
    bool in_doubt = false;  // a region too narrow for numbers, or a face along the ray, was passed
    for (std::size_t first = 0; first < hits_.size();) {
      // Surfaces within rounding of each other are crossed together; beyond `end` lies the next.
      const std::size_t last = together(first);
      const Real end = std::nextafter(hits_[last].t, pierce::kInfinity<Real>);
      const bool at_wall = hits_[first].geometry == 0;
      if (at_wall || one_in(8)) {
        if (const auto start = world_.all->next_origin(ray, hits_[first], Side::Before);
            start && !in_doubt) {
          ++tally_.reflections;
          at_ = *start;
          turn();
          return;
        }
        if (at_wall) break;
      }
      if (in_doubt || meets_twice(first, last)) {
        count_passages(ray, end, started_in);
      } else {
        for (std::size_t i = first; i <= last; ++i) in_[hits_[i].geometry].flip();
      }
      tally_.crossings += 1;
      if (const auto start = world_.all->next_origin(ray, hits_[last], Side::Beyond)) {
        at_ = *start;
        if (one_in(2)) turn();
        return;
      }
      in_doubt = true;
      ++tally_.squeezed;
      first = last + 1;
    }
    if (in_doubt) {  // all the way to the wall there was no place to stop: start anew from here
      in_ = started_in;
      turn();
      return;
    }
    ++tally_.lost;  // no wall
  }

  [[nodiscard]] std::size_t together(std::size_t first) const {
    std::size_t last = first;
    while (last + 1 < hits_.size() &&
           hits_[last + 1].t <= std::nextafter(hits_[last].t, pierce::kInfinity<Real>)) {
      ++last;
    }
    return last;
  }

  // Whether some volume's surface is met in several triangles: at an edge or a vertex, where the
  // ray may pass through or only touch.
  [[nodiscard]] bool meets_twice(std::size_t first, std::size_t last) const {
    for (std::size_t i = first; i <= last; ++i) {
      for (std::size_t j = i + 1; j <= last; ++j) {
        if (hits_[i].geometry == hits_[j].geometry) return true;
      }
    }
    return false;
  }

  // The exact way, for the rare cases: each passage through a volume's surface counts once.
  void count_passages(Ray ray, Real end, const std::vector<bool>& started_in) {
    ray.t_max = end;
    for (std::size_t i = 0; i < in_.size(); ++i) {
      in_[i] = started_in[i] != (world_.each[i].crossings(ray).count % 2 == 1);
    }
  }

  // Anywhere; now and then along an axis, or straight at a vertex.
  void turn() {
    do {
      direction_ = {unit() - Real(0.5), unit() - Real(0.5), unit() - Real(0.5)};
      if (one_in(8)) {
        const Point& target = world_.vertices[random_() % world_.vertices.size()];
        direction_ = {target.x - at_.x, target.y - at_.y, target.z - at_.z};
      } else if (one_in(16)) {
        const Real step = one_in(2) ? Real(1) : Real(-1);
        direction_ = one_in(3)   ? Point{step, 0, 0}
                     : one_in(2) ? Point{0, step, 0}
                                 : Point{0, 0, step};
      }
      // Along one too short, t might overflow.
    } while (std::abs(direction_.x) + std::abs(direction_.y) + std::abs(direction_.z) < Real(1e-6));
  }

  Real unit() { return static_cast<Real>(random_() >> 40) * Real(0x1p-24); }
  bool one_in(unsigned n) { return random_() % n == 0; }

  const World& world_;
  std::mt19937_64 random_;
  Point at_{}, direction_{};
  std::vector<bool> in_;  // volume i?
  std::vector<Hit> hits_;
  Tally tally_;
};

struct Options {
  std::uint64_t crossings = 100000, seed = 1;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  std::string mesh = "/usr/share/glmark2/models/bunny.obj";
};

// The walks of many particles, the same for every number of threads.
Tally run(const World& world, std::uint64_t crossings, const Options& options) {
  constexpr std::uint64_t kParticles = 64;
  std::array<Tally, kParticles> tallies;
  std::vector<std::thread> threads;
  for (unsigned thread = 0; thread < options.threads; ++thread) {
    threads.emplace_back([&, thread] {
      for (std::uint64_t i = thread; i < kParticles; i += options.threads) {
        const std::uint64_t share = (crossings + i) / kParticles;
        tallies[i] = Particle(world, options.seed * kParticles + i).fly(share);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  Tally sum;
  for (const Tally& tally : tallies) sum += tally;
  std::printf(
      "%-14s %12llu crossings, %llu reflections, %llu without room to stop; "
      "%llu lost, %llu in the wrong volume\n",
      world.name.c_str(), static_cast<unsigned long long>(sum.crossings),
      static_cast<unsigned long long>(sum.reflections),
      static_cast<unsigned long long>(sum.squeezed), static_cast<unsigned long long>(sum.lost),
      static_cast<unsigned long long>(sum.misplaced));
  std::fflush(stdout);
  return sum;
}

int usage(const std::string& complaint) {
  std::fprintf(stderr,
               "transport: %s\nusage: transport [--crossings N] [--seed S] [--threads T] "
               "[--mesh FILE.obj]\n",
               complaint.c_str());
  return 2;
}

}  // namespace

int main(int argc, char** argv) try {
  Options options;
  for (int i = 1; i < argc; i += 2) {
    const std::string name = argv[i];
    if (i + 1 == argc) return usage(name + " needs a value");
    const std::string value = argv[i + 1];
    if (name == "--mesh") {
      options.mesh = value;
      continue;
    }
    char* end = nullptr;
    const std::uint64_t number = std::strtoull(value.c_str(), &end, 10);
    if (*end != 0 || value.empty()) return usage(name + " needs a number, not '" + value + "'");
    if (name == "--crossings") {
      options.crossings = number;
    } else if (name == "--seed") {
      options.seed = number;
    } else if (name == "--threads") {
      options.threads = std::max(1U, static_cast<unsigned>(number));
    } else {
      return usage("there is no option " + name);
    }
  }
  std::vector<World> worlds;
  worlds.push_back(shells());
  worlds.push_back(packed_cubes());
  if (auto world = mesh_in_a_box(options.mesh)) {
    worlds.push_back(std::move(*world));
  } else {
    std::printf("%s is not there: without it\n", options.mesh.c_str());
  }
  Tally sum;
  for (const World& world : worlds) sum += run(world, options.crossings / worlds.size(), options);
  return sum.lost + sum.misplaced == 0 ? 0 : 1;
} catch (const std::exception& e) {
  std::fprintf(stderr, "transport: %s\n", e.what());
  return 1;
}
