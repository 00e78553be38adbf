// SPDX-License-Identifier: Apache-2.0
//
// The textbook's methods with every value on the way: what the headers in pierce/textbook compute,
// in the same order, and the test that said no. For `pierce triangle --steps`.
#pragma once

#include <array>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fractions.h"
#include "pierce/textbook/common.h"
#include "textbook/report.h"
#include "textbook/times.h"

namespace pierce::tool {

/// The methods that have steps, by their names in textbook::methods().
inline constexpr std::array<std::string_view, 8> kStepMethods = {
    "cramer",          "determinants",       "plane_then_edges", "plane_then_barycentric",
    "moller_trumbore", "precomputed_normal", "watertight",       "baldwin_weber"};

template <class Real>
struct Steps {
  std::vector<std::pair<std::string, Real>> values;  ///< of a vector three: "N x", "N y", "N z"
  std::string rejected;                              ///< such as "u < 0"; empty for a hit
  std::optional<TextbookHit<Real>> hit;
};

/// moller_trumbore with its default epsilon, 1e-5. Over float and double the hit is that of the
/// method itself, bit by bit. `method` is one of kStepMethods.
template <class Real>
[[nodiscard]] Steps<Real> steps_of(std::string_view method, const Pair<Real>& pair);

/// A table: every value in float, in double and exactly; then who rejects and why. Throws
/// UsageError if there is no such method.
void run_steps(std::string_view method, const TriangleQuestion& question, std::ostream& out);

extern template Steps<float> steps_of(std::string_view, const Pair<float>&);
extern template Steps<double> steps_of(std::string_view, const Pair<double>&);
extern template Steps<Fraction> steps_of(std::string_view, const Pair<Fraction>&);

}  // namespace pierce::tool
