// SPDX-License-Identifier: Apache-2.0
#include "suggest.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace pierce::tool {
namespace {

// A letter that is lost, doubled or swapped with its neighbour is a slip; another letter in its
// place is more of a difference.
constexpr std::size_t kSlip = 2, kOtherLetter = 3;

// Optimal string alignment distance, by rows of the usual table.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i * kSlip;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j * kSlip;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : kOtherLetter);
      d[i][j] = std::min({d[i - 1][j] + kSlip, d[i][j - 1] + kSlip, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + kSlip);
      }
    }
  }
  return d[a.size()][b.size()];
}

// One slip in a short word, three letters of another kind in one of twelve.
std::size_t farthest(std::string_view typed) { return std::max(kSlip, 3 * typed.size() / 4); }

std::string_view without_dashes(std::string_view word) {
  const std::size_t begin = word.find_first_not_of('-');
  return begin == word.npos ? std::string_view{} : word.substr(begin);
}

}  // namespace

std::string nearest_word(std::string_view typed, std::span<const std::string> words) {
  std::string bare(without_dashes(typed));
  for (char& c : bare) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  if (bare.size() < 2) return {};
  std::string best;
  std::size_t best_distance = farthest(bare) + 1;
  for (const std::string& word : words) {
    const std::string_view other = without_dashes(word);
    // "--output" for "--out", or the other way round.
    const bool begins = other.size() > 2 && bare.starts_with(other);
    const std::size_t distance = other.starts_with(bare) ? 0
                                 : begins                ? 1
                                                         : edit_distance(bare, other);
    if (distance >= best_distance) continue;
    best = word;
    best_distance = distance;
  }
  return best;
}

}  // namespace pierce::tool
