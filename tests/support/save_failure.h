// SPDX-License-Identifier: Apache-2.0
//
// Keeps what failed: a shrunk case in hex floats, appended to failures.txt where the test runs (or
// to the file that PIERCE_FAILURES names), so that a long run leaves more than a scrolled-away
// line.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

namespace pierce::hard {

/// Appends the case under the name of the running test; returns the text and where it is kept.
inline std::string saved(const std::string& text) {
  const char* wanted = std::getenv("PIERCE_FAILURES");
  const std::string path = wanted == nullptr ? "failures.txt" : wanted;
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  std::ofstream file(path, std::ios::app);
  file << test->test_suite_name() << "." << test->name() << "\n" << text << "\n\n";
  return text + (file ? "\n(kept in " + path + ")" : "\n(" + path + " cannot be written)");
}

}  // namespace pierce::hard
