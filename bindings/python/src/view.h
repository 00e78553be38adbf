// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

namespace pierce::python {

/// view_page_float and view_page_double, what bindings/python/pierce/_view.py calls.
void add_view(nanobind::module_& module);

}  // namespace pierce::python
