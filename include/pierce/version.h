// SPDX-License-Identifier: Apache-2.0
//
// Which pierce this is, for programs that want to know before they are linked.
#pragma once

namespace pierce {

/// Before 1.0 a minor version may change the interface, a patch may not.
inline constexpr int kVersionMajor = 0;
inline constexpr int kVersionMinor = 1;
inline constexpr int kVersionPatch = 0;
inline constexpr const char* kVersion = "0.1.0";

}  // namespace pierce
