// SPDX-License-Identifier: Apache-2.0
//
// The costs that the pages of the textbook methods name, counted by a number that counts: how many
// multiplications and divisions a hit takes, and the cheapest miss.
#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <ostream>
#include <string_view>
#include <utility>

#include "pierce/textbook.h"

namespace pierce {

// A double whose multiplications and divisions are counted.
struct Counted {
  double value = 0;
  static inline int multiplications = 0, divisions = 0;

  constexpr Counted() = default;
  constexpr Counted(double x) : value(x) {}
  constexpr Counted(int x) : value(x) {}

  friend Counted operator+(Counted a, Counted b) { return a.value + b.value; }
  friend Counted operator-(Counted a, Counted b) { return a.value - b.value; }
  friend Counted operator-(Counted a) { return -a.value; }
  friend Counted operator*(Counted a, Counted b) {
    ++multiplications;
    return a.value * b.value;
  }
  friend Counted operator/(Counted a, Counted b) {
    ++divisions;
    return a.value / b.value;
  }
  friend auto operator<=>(Counted a, Counted b) { return a.value <=> b.value; }
  friend bool operator==(Counted a, Counted b) { return a.value == b.value; }
};

}  // namespace pierce

template <>
class std::numeric_limits<pierce::Counted> {
 public:
  static constexpr bool is_specialized = true;
  static constexpr bool has_infinity = true;
  static constexpr pierce::Counted infinity() { return std::numeric_limits<double>::infinity(); }
};

namespace pierce {
namespace {

struct Cost {
  int multiplications, divisions;
  friend bool operator==(const Cost&, const Cost&) = default;
  friend std::ostream& operator<<(std::ostream& out, const Cost& cost) {
    return out << cost.multiplications << " multiplications, " << cost.divisions << " divisions";
  }
};

const Vec3<Counted> kA = {0, 0, 0}, kB = {1, 0, 0}, kC = {0, 1, 0};
const Ray<Counted> kHit = {{0.25, 0.25, 1}, {0, 0, -1}};
const Ray<Counted> kBehind = {{0.25, 0.25, 1}, {0, 0, 1}};
const Ray<Counted> kBesideU = {{-0.25, 0.25, 1}, {0, 0, -1}};

template <class Question>
Cost cost(const Question& question, bool is_hit) {
  Counted::multiplications = Counted::divisions = 0;
  EXPECT_EQ(question().has_value(), is_hit);
  return {Counted::multiplications, Counted::divisions};
}

TEST(TextbookCost, a_hit_by_each_method_costs_what_its_page_says) {
  const std::pair<std::string_view, Cost> expected[] = {
      {"cramer", {24, 3}},
      {"determinants", {36, 3}},
      {"plane_then_edges", {45, 3}},
      {"plane_then_barycentric", {19, 3}},
      {"moller_trumbore", {27, 1}},
      {"moller_trumbore, epsilon 0", {27, 1}},
      {"moller_trumbore_culling", {27, 1}},
      {"moller_trumbore_culling, epsilon 0", {27, 1}},
  };
  for (const auto& [name, known] : expected) {
    for (const textbook::Method<Counted>& method : textbook::methods<Counted>()) {
      if (method.name != name) continue;
      EXPECT_EQ(cost([&] { return method.test(kHit, kA, kB, kC); }, true), known) << name;
    }
  }
}

TEST(TextbookCost, a_miss_is_as_cheap_as_its_page_says) {
  using namespace textbook;
  EXPECT_EQ(cost([] { return cramer(kBehind, kA, kB, kC); }, false), (Cost{18, 1}));
  EXPECT_EQ(cost([] { return determinants(kBehind, kA, kB, kC); }, false), (Cost{18, 1}));
  EXPECT_EQ(cost([] { return plane_then_edges(kBehind, kA, kB, kC); }, false), (Cost{12, 1}));
  EXPECT_EQ(cost([] { return plane_then_barycentric(kBehind, kA, kB, kC); }, false), (Cost{12, 1}));
  EXPECT_EQ(cost([] { return moller_trumbore(kBesideU, kA, kB, kC); }, false), (Cost{13, 1}));
  EXPECT_EQ(cost([] { return moller_trumbore_culling(kBesideU, kA, kB, kC); }, false),
            (Cost{12, 0}));
}

TEST(TextbookCost, what_is_kept_with_the_triangle_or_the_ray_is_saved_at_every_test) {
  using namespace textbook;
  const NormalTriangle<Counted> normal(kA, kB, kC);
  EXPECT_EQ(cost([&] { return precomputed_normal(kHit, normal); }, true), (Cost{18, 3}));
  EXPECT_EQ(cost([&] { return precomputed_normal(kBehind, normal); }, false), (Cost{6, 1}));

  const AffineTriangle<Counted> affine(kA, kB, kC);
  EXPECT_EQ(cost([&] { return baldwin_weber(kHit, affine); }, true), (Cost{10, 1}));
  EXPECT_EQ(cost([&] { return baldwin_weber(kBehind, affine); }, false), (Cost{4, 1}));

  const ShearedRay<Counted> hit(kHit), beside(kBesideU);
  EXPECT_EQ(cost([&] { return watertight(hit, kA, kB, kC); }, true), (Cost{21, 1}));
  EXPECT_EQ(cost([&] { return watertight(beside, kA, kB, kC); }, false), (Cost{12, 0}));
}

TEST(TextbookCost, what_is_kept_costs_once) {
  using namespace textbook;
  const auto once = [](const auto& make) {
    Counted::multiplications = Counted::divisions = 0;
    make();
    return Cost{Counted::multiplications, Counted::divisions};
  };
  EXPECT_EQ(once([] { return NormalTriangle<Counted>(kA, kB, kC); }), (Cost{6, 0}));
  EXPECT_EQ(once([] { return AffineTriangle<Counted>(kA, kB, kC); }), (Cost{12, 6}));
  EXPECT_EQ(once([] { return ShearedRay<Counted>(kHit); }), (Cost{0, 3}));
}

}  // namespace
}  // namespace pierce
