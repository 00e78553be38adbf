// SPDX-License-Identifier: Apache-2.0
//
// Cases of one ray and one triangle that a test once kept (support/save_failure.h), read back:
//   PIERCE_REPLAY=failures.txt differential_one_triangle_test
// looks at these instead of drawing any.
#pragma once

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "support/hard_cases.h"

namespace pierce::hard {

/// The words of a case in show::text: seventeen numbers, and how its range begins.
inline std::vector<std::string> words_of_case(const std::string& text) {
  std::vector<std::string> words(1);
  for (const char c : text) {
    if (std::string("{}, \n").find(c) == std::string::npos) {
      words.back() += c;
    } else if (!words.back().empty()) {
      words.emplace_back();
    }
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

inline bool is_infinite(const std::string& word) { return word == "kInf" || word == "-kInf"; }

/// Whether a case was one of floats: its finite numbers end in f.
inline bool is_of_floats(const std::vector<std::string>& words) {
  for (const auto& word : words) {
    if (!is_infinite(word) && !word.starts_with("Range")) return word.back() == 'f';
  }
  return false;
}

/// The cases of type Real in a text, each as show::text writes it, whatever stands between them.
template <class Real>
std::vector<Case<Real>> cases_in(const std::string& text) {
  std::vector<Case<Real>> cases;
  const std::string last = "Range::";
  for (std::size_t at = text.find("{{{"); at != std::string::npos; at = text.find("{{{", at + 1)) {
    const std::size_t end = text.find('}', text.find(last, at));
    const auto words = words_of_case(text.substr(at, end - at));
    if (words.size() != 18) throw std::runtime_error("not a case: " + text.substr(at, end - at));
    if (is_of_floats(words) != std::is_same_v<Real, float>) continue;
    std::size_t next = 0;
    const auto number = [&] {
      const std::string& word = words[next++];
      if (!is_infinite(word)) return static_cast<Real>(std::strtod(word.c_str(), nullptr));
      const Real inf = std::numeric_limits<Real>::infinity();
      return word.front() == '-' ? -inf : inf;
    };
    Case<Real> hard;
    const auto read = [&](Vec3<Real>& v) {
      for (Real* x : {&v.x, &v.y, &v.z}) *x = number();
    };
    read(hard.ray.origin);
    read(hard.ray.direction);
    hard.ray.t_min = number();
    hard.ray.t_max = number();
    for (Vec3<Real>* corner : {&hard.a, &hard.b, &hard.c}) read(*corner);
    hard.range = words.back() == last + "Closed" ? Range::Closed : Range::OpenStart;
    cases.push_back(hard);
  }
  return cases;
}

/// Those of the file that PIERCE_REPLAY names, if it is set.
template <class Real>
std::optional<std::vector<Case<Real>>> replayed_cases() {
  const char* path = std::getenv("PIERCE_REPLAY");
  if (path == nullptr) return std::nullopt;
  std::ifstream file(path);
  if (!file) throw std::runtime_error(std::string("cannot read ") + path);
  return cases_in<Real>({std::istreambuf_iterator<char>(file), {}});
}

}  // namespace pierce::hard
