// SPDX-License-Identifier: Apache-2.0
//
// Options that take one of a few words: the help lists the words, and so does the error.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "suggest.h"

namespace pierce::tool {

template <class Value>
using Choices = std::vector<std::pair<std::string, Value>>;

template <class Value>
std::vector<std::string> words_of(const Choices<Value>& choices) {
  std::vector<std::string> words;
  for (const auto& choice : choices) words.push_back(choice.first);
  return words;
}

/// What a typed word of the option `name` stands for.
template <class Value>
Value chosen(const std::string& name, const Choices<Value>& choices, const std::string& typed) {
  for (const auto& [word, value] : choices) {
    if (word == typed) return value;
  }
  const std::vector<std::string> words = words_of(choices);
  const std::string near = nearest_word(typed, words);
  throw CLI::ValidationError(
      name, fmt::format("'{}' is none of {}{}", typed, fmt::join(words, ", "),
                        near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
}

/// An option `name` whose words stand for values; what `value` is before is the default.
template <class Value>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Value& value,
                        const Choices<Value>& choices, const std::string& text) {
  std::string by_default;
  for (const auto& [word, of_word] : choices) {
    if (of_word == value) by_default = word;
  }
  const auto set = [&value, choices, name](const CLI::results_t& typed) {
    value = chosen(name, choices, typed.at(0));
    return true;
  };
  return app.add_option(name, set, text)
      ->type_name(fmt::format("{}", fmt::join(words_of(choices), "|")))
      ->default_str(by_default);
}

/// The same for one or more words with commas between.
template <class Value>
CLI::Option* add_choices(CLI::App& app, const std::string& name, std::vector<Value>& values,
                         const Choices<Value>& choices, const std::string& text) {
  const auto set = [&values, choices, name](const CLI::results_t& typed) {
    values.clear();
    for (const std::string& word : typed) values.push_back(chosen(name, choices, word));
    return true;
  };
  return app.add_option(name, set, text)
      ->expected(1, static_cast<int>(choices.size()))
      ->delimiter(',')
      ->type_name(fmt::format("{},...", fmt::join(words_of(choices), "|")));
}

}  // namespace pierce::tool
