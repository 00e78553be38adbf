// SPDX-License-Identifier: Apache-2.0
//
// Which pierce this is. The numbers are those of the file VERSION; the build stops if they differ.
#pragma once

namespace pierce {

inline constexpr int kVersionMajor = 0;
inline constexpr int kVersionMinor = 1;
inline constexpr int kVersionPatch = 0;
inline constexpr const char* kVersion = "0.1.0";

}  // namespace pierce
