// SPDX-License-Identifier: Apache-2.0
//
// What every bound and every error-free transform takes for granted of the compiler: each operation
// is rounded once, to nearest, to its own type. scripts/check_flags.py holds this project's build
// to it; this holds every build that compiles these files, whoever wrote its flags.
#pragma once

#include <cfloat>

namespace pierce::exact {

static_assert(FLT_EVAL_METHOD == 0 || FLT_EVAL_METHOD == 16,
              "every operation must be rounded to its own type (on x86: SSE2, not the x87)");

#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
    defined(__NO_SIGNED_ZEROS__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ != 0)
#error "pierce is exact only without -ffast-math and its parts: add -fno-fast-math"
#endif

}  // namespace pierce::exact
