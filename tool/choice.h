// SPDX-License-Identifier: Apache-2.0
//
// Options that take one of a few words: the help lists the words, and so does the error.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "suggest.h"

namespace pierce::tool {

template <class Value>
using Choices = std::vector<std::pair<std::string, Value>>;

/// An option `name` whose words stand for values; what `value` is before is the default.
template <class Value>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Value& value,
                        const Choices<Value>& choices, const std::string& text) {
  std::vector<std::string> words;
  std::string by_default;
  for (const auto& [word, of_word] : choices) {
    words.push_back(word);
    if (of_word == value) by_default = word;
  }
  const auto set = [&value, choices, words, name](const CLI::results_t& typed) {
    const auto word = std::find(words.begin(), words.end(), typed.at(0));
    if (word == words.end()) {
      const std::string near = nearest_word(typed.at(0), words);
      throw CLI::ValidationError(
          name, fmt::format("'{}' is none of {}{}", typed.at(0), fmt::join(words, ", "),
                            near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
    }
    value = choices[static_cast<std::size_t>(word - words.begin())].second;
    return true;
  };
  return app.add_option(name, set, text)
      ->type_name(fmt::format("{}", fmt::join(words, "|")))
      ->default_str(by_default);
}

}  // namespace pierce::tool
