// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace pierce::io {

/// web/viewer/viewer.html; the build makes view_template.cpp of it.
extern const std::string_view kViewTemplate;

}  // namespace pierce::io
