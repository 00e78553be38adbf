// SPDX-License-Identifier: Apache-2.0
//
// JsonView: a value of a JSON document that knows its place, so that errors can name it.
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace pierce::io {

/// The document must outlive its views. Everything that is not as asked for throws Error (BadFile):
/// "name: accessors[3].count: expected ...".
class JsonView {
 public:
  JsonView(const nlohmann::json& document, const std::string& name)
      : value_(&document), name_(&name) {}

  [[nodiscard]] bool has(const char* key) const;
  [[nodiscard]] std::optional<JsonView> find(const char* key) const;
  [[nodiscard]] JsonView at(const char* key) const;
  /// Item of an array; which must be there.
  [[nodiscard]] JsonView at(std::uint64_t index) const;
  /// `at(list).at(index)`; says what names an item that is not there.
  [[nodiscard]] JsonView named(const char* list, const JsonView& index) const;
  [[nodiscard]] std::uint64_t size() const;  ///< of an array

  [[nodiscard]] std::uint64_t whole(std::uint64_t largest = kLargest) const;
  [[nodiscard]] std::uint64_t whole(const char* key, std::uint64_t otherwise) const;
  [[nodiscard]] double number() const;
  [[nodiscard]] const std::string& text() const;
  [[nodiscard]] bool flag(const char* key) const;  ///< false if it is not there

  [[nodiscard]] const std::string& where() const { return where_; }
  [[nodiscard]] const nlohmann::json& json() const { return *value_; }
  [[noreturn]] void fail(std::string_view message,
                         std::uint64_t index = std::numeric_limits<std::uint64_t>::max()) const;

  static constexpr std::uint64_t kLargest = std::uint64_t{1} << 53;

 private:
  const nlohmann::json* value_;
  const std::string* name_;
  std::string where_;
};

/// Throws Error (BadFile) naming the byte if `bytes` is no JSON.
[[nodiscard]] nlohmann::json parse_json(std::string_view bytes, const std::string& name);

}  // namespace pierce::io
