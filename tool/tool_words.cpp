// SPDX-License-Identifier: Apache-2.0
#include "tool_words.h"

#include <array>
#include <string_view>
#include <utility>

namespace pierce::tool {
namespace {

// What the library calls a thing, or might, and what the tool does.
constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kWords = {{
    {"the open-mesh option", "--open-mesh"},
    {"LocateOptions::open_mesh", "--open-mesh"},
    {"open_mesh", "--open-mesh"},
    {"the rule Odd", "--rule odd"},
    {"InsideRule::Odd", "--rule odd"},
    {"InsideRule::NonZero", "--rule nonzero"},
    {"the rule NonZero", "--rule nonzero"},
    {"InsideRule::Unique", "--rule unique"},
    {"the scene's type", "the numbers' type (--precision)"},
}};

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

}  // namespace

std::string in_tool_words(const Error& error) {
  std::string text = error.what();
  for (const auto& [library, tool] : kWords) replace_all(text, library, tool);
  if (error.code() == ErrorCode::NotClosed) {
    text += "; 'pierce info MESH --open-edges FILE' lists all such edges";
  }
  return text;
}

}  // namespace pierce::tool
