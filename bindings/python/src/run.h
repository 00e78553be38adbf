// SPDX-License-Identifier: Apache-2.0
//
// Work without the GIL that Ctrl-C ends.
#pragma once

#include <nanobind/nanobind.h>

#include <functional>

#include "pierce/options.h"

namespace pierce::python {

namespace nb = nanobind;

/// Whether work is too little for anybody to wish it to end before it does.
enum class Length : std::uint8_t { Brief, Long };

/// Whether work makes something that is thrown away when the call ends early, or changes what is
/// there. Who changes reports 1 to its progress before it does, and leaves all as it was if that
/// throws: it does if a signal or `progress` has ended the call. Afterwards nothing ends it.
enum class Work : std::uint8_t { Makes, Changes };

/// What a call says about how it is to be done.
struct Control {
  unsigned threads = 0;
  nb::object progress = nb::none();  ///< None or a function of the finished fraction
};

/// Calls `work`, which must not touch Python, without the GIL. Long work goes on in a thread of its
/// own while this one looks after signals and tells `progress` some twenty times a second; what
/// either throws stops the work within 50 ms and is thrown from here.
void run(const Control& control, Length length, const std::function<void(const WorkOptions&)>& work,
         Work kind = Work::Makes);

}  // namespace pierce::python
