// SPDX-License-Identifier: Apache-2.0
//
// AnswerPrinter: the answers to questions that were asked on the command line, on standard output:
// a line of words each, or with --json members of one object.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "file_options.h"

namespace pierce::tool {

class AnswerPrinter {
 public:
  /// `json`: begun and open if --json was given. `questions`: how many there are; the lines of one
  /// are not numbered. `what` they are: "ray".
  AnswerPrinter(bool as_json, io::JsonWriter json, std::string what, std::size_t questions)
      : as_json_(as_json), json_(std::move(json)), what_(std::move(what)), questions_(questions) {
    if (as_json_) json_.open_array("answers");
  }

  /// The next question's answer: its lines, or what `add(json)` puts into an object of its own.
  template <class Words, class Add>
  void answer(const Words& words, const Add& add) {
    if (as_json_) {
      json_.open_object();
      add(json_);
      json_.close_object();
    } else {
      words([&](std::string_view line) {
        if (questions_ > 1) text_ += what_ + " " + std::to_string(next_) + ": ";
        text_.append(line).append("\n");
      });
    }
    ++next_;
  }

  void finish() {
    if (!as_json_) return print(text_);
    json_.close_array();
    finish_json(json_);
  }

 private:
  bool as_json_;
  io::JsonWriter json_;
  std::string what_, text_;
  std::size_t questions_, next_ = 0;
};

}  // namespace pierce::tool
