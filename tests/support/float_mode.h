// SPDX-License-Identifier: Apache-2.0
//
// Floating-point modes that a caller may be in.
#pragma once

#include <array>
#include <cfenv>
#include <cstdint>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace pierce::hard {

/// How results are rounded, and whether denormal numbers are lost.
struct FloatMode {
  const char* name;
  int rounding;
  bool flush_results = false, flush_inputs = false;  // one thing on Arm
};

inline constexpr FloatMode kFloatModes[] = {
    {"upward", FE_UPWARD},
    {"downward", FE_DOWNWARD},
    {"toward zero", FE_TOWARDZERO},
    {"flush to zero", FE_TONEAREST, true, false},
    {"denormals are zero", FE_TONEAREST, false, true},
    {"as -ffast-math starts a program", FE_TONEAREST, true, true},
    {"everything at once", FE_DOWNWARD, true, true},
};

/// The register that says all that, without the flags of what has happened.
inline std::uint64_t float_control() {
#if defined(__SSE2__)
  return _mm_getcsr() & ~0x3fU;
#elif defined(__aarch64__)
  std::uint64_t control;
  asm volatile("mrs %0, fpcr" : "=r"(control));
  return control;
#else
  return static_cast<std::uint64_t>(std::fegetround());
#endif
}

/// `ask()` in the mode, and whether the mode was the same afterwards.
template <class Ask>
[[nodiscard]] bool in_mode(const FloatMode& mode, const Ask& ask) {
  std::fenv_t before;
  std::fegetenv(&before);
  std::fesetround(mode.rounding);
#if defined(__SSE2__)
  _mm_setcsr(_mm_getcsr() | (mode.flush_results ? 0x8000U : 0U) | (mode.flush_inputs ? 0x40U : 0U));
#elif defined(__aarch64__)
  if (mode.flush_results || mode.flush_inputs) {
    asm volatile("msr fpcr, %0" : : "r"(float_control() | (std::uint64_t{1} << 24)));
  }
#endif
  const std::uint64_t asked_in = float_control();
  ask();
  const bool same = float_control() == asked_in;
  std::fesetenv(&before);
  return same;
}

}  // namespace pierce::hard
