// SPDX-License-Identifier: Apache-2.0
//
// Measures of a mesh by itself, and where it passes through itself.
#pragma once

#include <nanobind/nanobind.h>

namespace pierce::python {

void add_measures(nanobind::module_& module);

}  // namespace pierce::python
