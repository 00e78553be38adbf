// SPDX-License-Identifier: Apache-2.0
//
// What the benchmark compares: engines (something built over a mesh) and contenders (a way to ask
// an engine). Every contender is set up as its own best users would set it up.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "pierce/options.h"
#include "workloads/mesh.h"
#include "workloads/rays.h"

namespace pierce::bench {

enum class Query : std::uint8_t { Closest, Any };
[[nodiscard]] inline const char* name_of(Query query) {
  return query == Query::Closest ? "closest" : "any";
}

/// What came out, in words that all contenders share.
struct Answers {
  std::vector<Hit<float>> hits;          ///< Closest; an inexact contender leaves out what it lacks
  std::vector<Hit<double>> hits_double;  ///< Closest, of a double scene; else empty
  std::vector<std::uint8_t> any;         ///< Any
};

struct BuildFigures {
  double seconds = 0;
  std::uint64_t bytes = 0;  ///< kept after the build, beside the caller's mesh
  double sah_cost = 0;      ///< 0: the engine does not tell
};

class Engine {
 public:
  explicit Engine(std::string name) : name_(std::move(name)) {}
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;
  virtual ~Engine() = default;

  [[nodiscard]] const std::string& name() const { return name_; }

  /// Builds over the mesh, which outlives the engine's use; replaces what was built before.
  virtual BuildFigures build(const Mesh& mesh, unsigned threads) = 0;
  virtual void release() = 0;

  /// Meshes with more triangles are left out: no sensible user would come here with them.
  [[nodiscard]] virtual std::uint64_t most_triangles() const { return ~std::uint64_t{0}; }

 private:
  std::string name_;
};

/// How far answers are compared before a contender is timed.
enum class Kind : std::uint8_t {
  Exact,   ///< must agree with the reference bit for bit, else nothing is timed
  Double,  ///< the same of a double scene: every decision agrees, t rounds to the float t
  Other,   ///< differences are counted and reported
};

class Contender {
 public:
  Contender(std::string name, Kind kind, Engine& engine)
      : name_(std::move(name)), kind_(kind), engine_(&engine) {}
  Contender(const Contender&) = delete;
  Contender& operator=(const Contender&) = delete;
  virtual ~Contender() = default;

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] Kind kind() const { return kind_; }
  [[nodiscard]] Engine& engine() const { return *engine_; }

  /// Slow contenders answer only so many rays of a set, evenly spread over it.
  [[nodiscard]] virtual std::size_t most_rays() const { return ~std::size_t{0}; }

  /// Not timed: bring the rays into the layout this contender likes best. The set outlives the run.
  virtual void prepare(const RaySet& set, Query query, unsigned threads) = 0;
  /// Timed: answer all of them.
  virtual void run() = 0;
  /// Not timed: hand over the last run's answers.
  virtual void collect(Answers& answers) = 0;
  /// Not timed: the figures of the ladder over the same rays; false if there is no ladder.
  virtual bool statistics(Statistics&) { return false; }

  [[nodiscard]] unsigned threads() const { return threads_; }

 protected:
  unsigned threads_ = 1;  ///< that the last prepare chose

 private:
  std::string name_;
  Kind kind_;
  Engine* engine_;
};

/// Engines and contenders of this build; those that a missing library takes away are not in it.
struct Field {
  std::vector<std::unique_ptr<Engine>> engines;
  std::vector<std::unique_ptr<Contender>> contenders;
};

struct ContenderKind {
  std::string name, description;
  std::string family;  ///< pierce, embree, cgal, textbook: the words of --against
  bool by_default;
};

[[nodiscard]] const std::vector<ContenderKind>& contender_kinds();

/// Makes the named ones, in order. Throws Error (InvalidArgument) that lists the names there are.
[[nodiscard]] Field make_field(const std::vector<std::string>& names);

}  // namespace pierce::bench
