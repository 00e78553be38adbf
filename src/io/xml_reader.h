// SPDX-License-Identifier: Apache-2.0
//
// XML as a row of elements that open and close, by Expat.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace pierce::io {

/// "http://... name", or the name alone where there is no namespace.
struct XmlName {
  std::string_view space, local;
};

/// An element and its attributes, good as long as the call. Line: where it stands.
class XmlElement {
 public:
  XmlElement(const char* name, const char* const* attributes, std::uint64_t line)
      : name_(name), attributes_(attributes), line_(line) {}

  [[nodiscard]] XmlName name() const;
  /// An attribute without a namespace, or with this one.
  [[nodiscard]] std::optional<std::string_view> attribute(std::string_view local,
                                                          std::string_view space = {}) const;
  [[nodiscard]] std::uint64_t line() const { return line_; }

 private:
  const char* name_;
  const char* const* attributes_;
  std::uint64_t line_;
};

struct XmlCalls {
  std::function<void(const XmlElement&)> open;
  std::function<void(XmlName)> close;
  /// A prefix gets a meaning; before the element that says so is opened.
  std::function<void(std::string_view prefix, std::string_view space)> prefix;
};

/// Throws Error (BadFile) with the line if the text is not well formed, and whatever a call throws.
void read_xml(std::string_view text, const std::string& name, const XmlCalls& calls);

}  // namespace pierce::io
