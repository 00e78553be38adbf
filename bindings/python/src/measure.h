// SPDX-License-Identifier: Apache-2.0
//
// Of a mesh by itself: measures, where it passes through itself, vertices made one.
#pragma once

#include <nanobind/nanobind.h>

namespace pierce::python {

void add_measures(nanobind::module_& module);

}  // namespace pierce::python
