// SPDX-License-Identifier: Apache-2.0
//
// The textbook methods over arrays of rays and triangles.
#pragma once

#include <nanobind/nanobind.h>

namespace pierce::python {

void add_textbook(nanobind::module_& module);

}  // namespace pierce::python
