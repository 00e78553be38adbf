// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace pierce::io {

/// The bytes that the digits of RFC 4648 stand for, with or without padding; nothing if there is
/// anything else among them.
[[nodiscard]] std::optional<std::string> decode_base64(std::string_view text);

}  // namespace pierce::io
