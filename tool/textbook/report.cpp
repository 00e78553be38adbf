// SPDX-License-Identifier: Apache-2.0
//
// pierce textbook: every method on easy and hard rays, against exact decisions.
#include "textbook/report.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <ostream>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "failure.h"
#include "fractions.h"
#include "pierce/intersect.h"
#include "pierce/textbook.h"
#include "textbook/rays.h"
#include "textbook/times.h"

namespace pierce::tool {
namespace {

constexpr std::size_t kTimed = 1024;  // pairs: few enough to stay in the cache

struct Row {
  std::string_view method, type;
  bool front_only = false;
  double ns = 0;
  std::array<std::uint64_t, kRayKinds.size()> missed = {}, false_hits = {};
  std::array<std::vector<double>, 3> errors;  // of t, u, v, in ulp, on easy rays
};

// One row a method; then, for the types that it answers for, the library's own.
template <class Real>
std::vector<Row> empty_rows(std::string_view type) {
  std::vector<Row> rows;
  const auto add = [&](std::string_view method, bool front_only) {
    Row& row = rows.emplace_back();
    row.method = method;
    row.type = type;
    row.front_only = front_only;
  };
  for (const auto& method : textbook::methods<Real>()) add(method.name, method.front_only);
  if (!std::is_same_v<Real, long double>) add("pierce::intersect", false);
  return rows;
}

template <class Input, class Test>
void judge_method(const std::vector<TextbookRay<Input>>& pairs, std::size_t kind, const Test& test,
                  Row& row) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto hit = test(i);
    const auto& answer = pairs[i].answer;
    const bool expected = answer && (pairs[i].front || !row.front_only);
    if (expected && !hit) ++row.missed[kind];
    if (!expected && hit) ++row.false_hits[kind];
    if (expected && hit && kind == kEasy) {
      row.errors[0].push_back(error_in_ulp(hit->t, (*answer)[0]));
      row.errors[1].push_back(error_in_ulp(hit->u, (*answer)[1]));
      row.errors[2].push_back(error_in_ulp(hit->v, (*answer)[2]));
    }
  }
}

template <class Real, class Input>
void judge(const std::vector<TextbookRay<Input>>& pairs, std::size_t kind, std::vector<Row>& rows) {
  std::vector<Pair<Real>> block;
  for (const TextbookRay<Input>& pair : pairs) {
    block.push_back({convert<Real>(pair.ray), convert<Real>(pair.a), convert<Real>(pair.b),
                     convert<Real>(pair.c)});
  }
  const auto methods = textbook::methods<Real>();
  for (std::size_t m = 0; m < methods.size(); ++m) {
    judge_method(
        pairs, kind,
        [&](std::size_t i) {
          const auto& [ray, a, b, c] = block[i];
          return methods[m].test(ray, a, b, c);
        },
        rows[m]);
  }
  if constexpr (!std::is_same_v<Real, long double>) {
    judge_method(
        pairs, kind,
        [&](std::size_t i) {
          const auto& [ray, a, b, c] = block[i];
          return intersect(ray, a, b, c);
        },
        rows.back());
  }
  if (kind != kEasy) return;
  block.resize(std::min(block.size(), kTimed));
  const std::vector<double> ns = ns_per_test(block);
  for (std::size_t m = 0; m < rows.size(); ++m) rows[m].ns = ns[m];
}

std::uint64_t sum_of_hard(const std::array<std::uint64_t, kRayKinds.size()>& counts) {
  std::uint64_t sum = 0;
  for (std::size_t kind = kEasy + 1; kind < kRayKinds.size(); ++kind) sum += counts[kind];
  return sum;
}

// "0.4 / 1.2e+03"
std::string median_and_largest(std::vector<double>& errors) {
  if (errors.empty()) return "";
  const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  return fmt::format("{:.2g} / {:.2g}", *middle, *std::max_element(errors.begin(), errors.end()));
}

void print_rows(std::vector<Row>& rows, std::ostream& out) {
  fmt::print(out, "| {:<34} | {:<11} | {:>5} |", "method", "type", "ns");
  for (const char* rays : {"easy", "hard"}) fmt::print(out, " {0} missed | {0} false |", rays);
  for (const char* number : {"t", "u", "v"}) fmt::print(out, " {:>14} |", number);
  fmt::print(out, "\n| {:-<34} | {:-<11} | {:->4}: |", "", "", "");
  for (int i = 0; i < 2; ++i) fmt::print(out, " {:->10}: | {:->9}: |", "", "");
  for (int i = 0; i < 3; ++i) fmt::print(out, " {:->13}: |", "");
  for (Row& row : rows) {
    fmt::print(out, "\n| {:<34} | {:<11} | {:>5.1f} | {:>11} | {:>10} | {:>11} | {:>10} |",
               row.method, row.type, row.ns, row.missed[kEasy], row.false_hits[kEasy],
               sum_of_hard(row.missed), sum_of_hard(row.false_hits));
    for (auto& errors : row.errors) fmt::print(out, " {:>14} |", median_and_largest(errors));
  }
  fmt::print(out, "\n");
}

void print_by_kind(const std::vector<Row>& rows, std::ostream& out) {
  fmt::print(out, "| {:<34} | {:<11} |", "method", "type");
  for (std::size_t kind = kEasy + 1; kind < kRayKinds.size(); ++kind) {
    fmt::print(out, " {:>9} |", kRayKinds[kind]);
  }
  fmt::print(out, "\n| {:-<34} | {:-<11} |", "", "");
  for (std::size_t kind = kEasy + 1; kind < kRayKinds.size(); ++kind) {
    fmt::print(out, " {:->8}: |", "");
  }
  for (const Row& row : rows) {
    fmt::print(out, "\n| {:<34} | {:<11} |", row.method, row.type);
    for (std::size_t kind = kEasy + 1; kind < kRayKinds.size(); ++kind) {
      fmt::print(out, " {:>9} |", row.missed[kind] + row.false_hits[kind]);
    }
  }
  fmt::print(out, "\n");
}

}  // namespace

void run_textbook(std::uint64_t rays, std::uint64_t seed, std::ostream& out) {
  if (rays < kRayKinds.size() - 1) {
    throw UsageError(
        fmt::format("--rays: at least {}, one of each hard kind", kRayKinds.size() - 1));
  }
  std::vector<Row> rows = empty_rows<float>("float");
  std::vector<Row> double_rows = empty_rows<double>("double");
  std::vector<Row> long_double_rows = empty_rows<long double>("long double");
  for (std::size_t kind = 0; kind < kRayKinds.size(); ++kind) {
    const std::size_t kinds = kRayKinds.size() - 1;
    const std::uint64_t count =
        kind == kEasy ? rays : rays / kinds + (kind <= rays % kinds ? 1 : 0);
    judge<float>(textbook_rays<float>(kind, count, seed), kind, rows);
    const auto pairs = textbook_rays<double>(kind, count, seed);
    judge<double>(pairs, kind, double_rows);
    judge<long double>(pairs, kind, long_double_rows);
  }
  rows.insert(rows.end(), double_rows.begin(), double_rows.end());
  rows.insert(rows.end(), long_double_rows.begin(), long_double_rows.end());

  fmt::print(
      out,
      "{0} easy rays and {0} hard ones, seed {1}. ns: the time of one test on easy rays, what the\n"
      "method keeps made beforehand. missed: hits called misses; false: misses called hits.\n"
      "t, u, v: median / largest error on easy rays, in ulp.\n\n",
      rays, seed);
  print_rows(rows, out);
  const std::uint64_t each = rays / (kRayKinds.size() - 1);
  fmt::print(out, "\nWrong decisions by kind of hard ray, of {}{} each:\n\n", each,
             each * (kRayKinds.size() - 1) == rays ? "" : " or one more");
  print_by_kind(rows, out);
}

}  // namespace pierce::tool
