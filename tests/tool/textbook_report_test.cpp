// SPDX-License-Identifier: Apache-2.0
//
// What `pierce triangle` and `pierce textbook` say: fractions and their roundings, verdicts that
// are right, refusals, and decisions that depend on nothing but the seed.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "failure.h"
#include "fractions.h"
#include "pierce/textbook/methods.h"
#include "textbook/rays.h"
#include "textbook/report.h"
#include "textbook/steps.h"

namespace pierce::tool {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr std::array<double, 9> kUnit = {0, 0, 0, 1, 0, 0, 0, 1, 0};

std::string report(const std::array<double, 9>& triangle, const std::vector<double>& ray) {
  std::ostringstream out;
  run_triangle(triangle_question(triangle, ray), out);
  return out.str();
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::vector<std::string> lines_with(const std::string& text, const std::string& part) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (says(line, part)) lines.push_back(line);
  }
  return lines;
}

TEST(Fractions, decimals_are_rounded_once_to_the_nearest) {
  const auto ratio = [](int n, int d) { return Fraction(n) / d; };
  EXPECT_EQ(as_fraction(ratio(-6, 4)), "-3/2");
  EXPECT_EQ(as_fraction(Fraction(7)), "7");
  EXPECT_EQ(as_decimal(ratio(1, 3), 5), "0.33333");
  EXPECT_EQ(as_decimal(ratio(2, 3), 5), "0.66667");
  EXPECT_EQ(as_decimal(ratio(-1, 800), 5), "-0.00125");
  EXPECT_EQ(as_decimal(ratio(1, 3000000), 3), "3.33e-7");
  EXPECT_EQ(as_decimal(ratio(99999, 100), 3), "1000") << "the digits carry over";
  EXPECT_EQ(as_decimal(ratio(25, 10), 1), "2") << "ties to even";
  EXPECT_EQ(as_decimal(ratio(35, 10), 1), "4");
  EXPECT_EQ(as_decimal(Fraction(0), 5), "0");
  EXPECT_EQ(as_decimal(Fraction(1e300), 4), "1e300");
  EXPECT_TRUE(is_decimal(ratio(1, 8), 3));
  EXPECT_FALSE(is_decimal(ratio(1, 8), 2));
  EXPECT_FALSE(is_decimal(ratio(1, 3), 20));
}

TEST(Fractions, errors_are_in_units_of_the_last_place_of_the_exact_number) {
  EXPECT_EQ(error_in_ulp(1.0f, reference(Fraction(1))), 0);
  EXPECT_EQ(error_in_ulp(std::nextafter(1.0f, 2.0f), reference(Fraction(1))), 1);
  EXPECT_EQ(error_in_ulp(std::nextafter(1.0, 0.0), reference(Fraction(1))), 0.5)
      << "the last place of 1 is twice that of the number below";
  EXPECT_EQ(error_in_ulp(1.5, reference(Fraction(1.5) + Fraction(0x1p-54))), 0.25);
  EXPECT_EQ(error_in_ulp(0x1p-149f, reference(Fraction(0))), 1) << "the smallest float above 0";
  EXPECT_EQ(error_in_ulp(std::numeric_limits<double>::quiet_NaN(), reference(Fraction(1))), kInf);
  const double third = 1.0 / 3;
  EXPECT_NEAR(error_in_ulp(third, reference(Fraction(1) / 3)), 1.0 / 3, 1e-15);
  EXPECT_EQ(nearest<double>(Fraction(1) / 3), third);
}

TEST(TriangleReport, a_hit_is_told_in_fractions_and_by_where_it_is) {
  const std::string inside = report(kUnit, {0.25, 0.25, 1, 0, 0, -3});
  EXPECT_TRUE(says(inside, "exact: hit, inside, from the front"));
  EXPECT_TRUE(says(inside, "t = 1/3\n"));
  EXPECT_TRUE(says(inside, "~ 0.33333333333333333333 "));
  EXPECT_TRUE(says(inside, "u = 1/4\n    = 0.25 "));
  EXPECT_TRUE(says(inside, "0 of 35 decisions are wrong"));
  EXPECT_TRUE(
      says(report(kUnit, {0.5, 0.5, -1, 0, 0, 1}), "exactly on the edge bc, from the back"));
  EXPECT_TRUE(says(report(kUnit, {1, 0, 1, 0, 0, -1}), "exactly at the vertex b, from the front"));
}

TEST(TriangleReport, a_miss_is_told_with_its_reason) {
  EXPECT_TRUE(says(report(kUnit, {-1, 0.5, 1, 0, 0, -1}), "exact: miss: u < 0\n"));
  EXPECT_TRUE(says(report(kUnit, {1, 1, 1, 0, 0, 1}), "exact: miss: w < 0, t < t_min\n"));
  EXPECT_TRUE(says(report(kUnit, {0, 0, 1, 0, 0, -1, 0, 0.5}), "exact: miss: t > t_max\n"));
  EXPECT_TRUE(says(report(kUnit, {-1, 0, 0, 1, 0, 0}), "lies in the plane"));
  EXPECT_TRUE(says(report(kUnit, {-1, 0, 1, 1, 0, 0}), "parallel to the plane"));
  EXPECT_TRUE(says(report({0, 0, 0, 1, 1, 1, 2, 2, 2}, {0, 0, 1, 0, 0, -1}), "has no area"));
}

TEST(TriangleReport, a_range_can_be_given_and_be_infinite) {
  EXPECT_TRUE(says(report(kUnit, {0, 0, 1, 0, 0, 1}), "miss: t < t_min"));
  EXPECT_TRUE(says(report(kUnit, {0, 0, 1, 0, 0, 1, -kInf, kInf}), "hit, exactly at the vertex a"));
}

TEST(TriangleReport, wrong_decisions_are_called_wrong_and_the_librarys_own_is_right) {
  const std::string text = report({2, -4, 3, -1, 2, -4, 1, 1, -3},
                                  {0, -3, 8, 0x1.0264fp-4, 0x1.634acap-2, -0x1.df1b28p-1});
  EXPECT_TRUE(says(text, "w = 1/50802385\n"));
  EXPECT_EQ(lines_with(text, "WRONG: misses it").size(), 9U);
  EXPECT_EQ(lines_with(text, "the back is culled").size(), 6U);
  for (const std::string& line : lines_with(text, "pierce::intersect")) {
    EXPECT_TRUE(line.ends_with("right")) << line;
  }
  EXPECT_TRUE(says(text, "9 of 35 decisions are wrong"));
}

TEST(TriangleReport, float_rows_answer_for_the_numbers_rounded_to_float_and_say_so) {
  EXPECT_FALSE(says(report(kUnit, {0.25, 0.25, 1, 0, 0, -3}), "rounded"));
  EXPECT_TRUE(says(report(kUnit, {0.1, 0.25, 1, 0, 0, -3}), "exact, of the rounded numbers: hit"));
  const std::string huge = report(kUnit, {0.25, 0.25, 1e200, 0, 0, -1e200});
  EXPECT_TRUE(says(huge, "beyond the range of float"));
  EXPECT_TRUE(says(huge, "of 23 decisions"));
}

TEST(TriangleReport, numbers_that_make_no_ray_or_triangle_are_refused) {
  const auto refuse = [](const std::vector<double>& triangle, const std::vector<double>& ray) {
    return triangle_question(triangle, ray);
  };
  const std::vector<double> unit(kUnit.begin(), kUnit.end());
  EXPECT_THROW(refuse({1, 2, 3}, {0, 0, 1, 0, 0, 1}), UsageError);
  EXPECT_THROW(refuse(unit, {0, 0, 1, 0, 0, 1, 5}), UsageError);
  EXPECT_THROW(refuse(unit, {0, 0, 1, 0, 0, 0}), Error);
  EXPECT_THROW(refuse(unit, {0, kInf, 1, 0, 0, 1}), Error);
  EXPECT_THROW(refuse(unit, {0, 0, 1, 0, 0, 1, std::nan(""), 1}), Error);
  EXPECT_THROW(refuse({0, 0, 0, 1, 0, 0, 0, kInf, 0}, {0, 0, 1, 0, 0, 1}), Error);
}

template <class Real>
void expect_steps_to_end_as_their_methods() {
  int hits = 0, rejected = 0;
  for (std::size_t kind = 0; kind < kRayKinds.size(); ++kind) {
    for (const TextbookRay<Real>& x : textbook_rays<Real>(kind, 60, 5)) {
      for (const textbook::Method<Real>& method : textbook::methods<Real>()) {
        if (std::find(kStepMethods.begin(), kStepMethods.end(), method.name) == kStepMethods.end())
          continue;
        const Steps<Real> steps = steps_of<Real>(method.name, {x.ray, x.a, x.b, x.c});
        ASSERT_EQ(steps.hit, method.test(x.ray, x.a, x.b, x.c)) << method.name;
        ASSERT_EQ(steps.rejected.empty(), steps.hit.has_value()) << method.name;
        ++(steps.hit ? hits : rejected);
        const Pair<Fraction> exactly = {convert<Fraction>(x.ray), convert<Fraction>(x.a),
                                        convert<Fraction>(x.b), convert<Fraction>(x.c)};
        const bool wrong = method.epsilon;  // even over fractions
        if (!wrong) {
          ASSERT_EQ(steps_of(method.name, exactly).hit.has_value(), x.answer.has_value());
        }
      }
    }
  }
  EXPECT_GT(hits, 100);
  EXPECT_GT(rejected, 100);
}

TEST(TriangleSteps, a_method_ends_as_its_steps_do_and_over_fractions_it_is_right) {
  expect_steps_to_end_as_their_methods<float>();
  expect_steps_to_end_as_their_methods<double>();
}

TEST(TriangleSteps, what_rejects_is_told_and_what_follows_is_left_out) {
  std::ostringstream out;
  run_steps("determinants", triangle_question(kUnit, std::vector<double>{2, 0.25, 1, 0, 0, -1}),
            out);
  const std::string text = out.str();
  EXPECT_TRUE(says(text, "\nD0              1                   1                         1\n"));
  EXPECT_TRUE(says(text, "\nu               2                   2                         2\n"));
  EXPECT_FALSE(says(text, "Dv"));
  EXPECT_TRUE(says(text, "in float: miss, since u > 1\nin double: miss, since u > 1\n"));
  std::ostringstream refused;
  EXPECT_THROW(
      run_steps("nix", triangle_question(kUnit, std::vector<double>{0, 0, 1, 0, 0, -1}), refused),
      UsageError);
}

TEST(TrianglePicture, shows_the_hit_and_nothing_that_is_no_number) {
  const auto picture = [](const std::vector<double>& ray) {
    return triangle_picture(triangle_question(kUnit, ray));
  };
  const std::string hit = picture({0.25, 0.25, 1, 0, 0, -3});
  EXPECT_TRUE(says(hit, "<title>hit, inside, from the front</title>"));
  EXPECT_TRUE(says(hit, ">P</text>"));
  EXPECT_TRUE(says(picture({-1, 0.5, 1, 0, 0, -1}), "<title>miss: u &lt; 0</title>"));
  EXPECT_FALSE(says(picture({0, 0, 1, 1, 0, 0}), ">P</text>")) << "parallel";
  for (const double size : {1e-300, 1e300}) {
    const std::vector<double> ray = {0.25 * size, 0.25 * size, size, 0, 0, -size};
    const std::array<double, 9> corners = {0, 0, 0, size, 0, 0, 0, size, 0};
    const std::string drawn = triangle_picture(triangle_question(corners, ray));
    EXPECT_EQ(lines_with(drawn, "circle"),
              lines_with(picture({0.25, 0.25, 1, 0, 0, -1}), "circle"));
  }
  const std::string point = triangle_picture(
      triangle_question(std::array<double, 9>{}, std::vector<double>{0, 0, 0, 1, 0, 0}));
  EXPECT_FALSE(says(point, "nan") || says(point, "inf")) << point;
}

// The tables without the times.
std::vector<std::string> timeless_rows(std::uint64_t rays, std::uint64_t seed) {
  std::ostringstream out;
  run_textbook(rays, seed, out);
  std::vector<std::string> rows = lines_with(out.str(), "| ");
  for (std::string& row : rows) {
    if (row.size() > 140) row.erase(53, 8);
  }
  return rows;
}

TEST(TextbookReport, everything_but_the_times_depends_on_the_seed_alone) {
  const std::vector<std::string> rows = timeless_rows(300, 1);
  EXPECT_EQ(rows.size(), 2 * (2 + 35U));
  EXPECT_EQ(timeless_rows(300, 1), rows);
  EXPECT_NE(timeless_rows(300, 2), rows);
}

TEST(TextbookReport, the_librarys_own_decisions_are_all_right_and_others_are_not) {
  std::ostringstream out;
  run_textbook(600, 3, out);
  const auto own = lines_with(out.str(), "| pierce::intersect");
  ASSERT_EQ(own.size(), 4U);
  for (const std::string& row : own) {
    EXPECT_FALSE(says(row, "e+")) << row;  // no large error
    for (const char* digit : {" 1 |", " 2 |", " 3 |"}) EXPECT_FALSE(says(row, digit)) << row;
  }
  EXPECT_TRUE(says(own[0], "/ 0.5 |") || says(own[0], "/ 0.49 |")) << "rounded correctly";
  EXPECT_TRUE(says(own[2], "|         0 |         0 |         0 |         0 |         0 |"));
  const auto others = lines_with(out.str(), "| watertight ");
  ASSERT_EQ(others.size(), 6U);
  EXPECT_FALSE(says(others[3], "|         0 |         0 |         0 |         0 |         0 |"));
}

TEST(TextbookReport, too_few_rays_are_refused) {
  std::ostringstream out;
  EXPECT_THROW(run_textbook(5, 1, out), UsageError);
}

}  // namespace
}  // namespace pierce::tool
