// SPDX-License-Identifier: Apache-2.0
//
// The floating-point mode that all proofs of this library suppose: results rounded to nearest,
// denormal numbers kept, no traps. A caller may have another one (-ffast-math flushes denormals to
// zero from the start of the program); its threads, too.
#pragma once

#include <cstdint>

#if defined(__SSE2__) || defined(_M_X64)
#include <xmmintrin.h>
#endif

namespace pierce {

/// The default mode for as long as this object lives; then the mode from before, if that was
/// another. A few cycles where it is the default already.
class FloatEnvironment {
 public:
  FloatEnvironment() : before_(get()) {
    if (!is_default(before_)) [[unlikely]]
      set(kDefault);
    keep_order();
  }
  ~FloatEnvironment() {
    keep_order();
    if (!is_default(before_)) [[unlikely]]
      set(before_);
  }
  FloatEnvironment(const FloatEnvironment&) = delete;
  FloatEnvironment& operator=(const FloatEnvironment&) = delete;

 private:
#if defined(__SSE2__) || defined(_M_X64)
  using Control = std::uint32_t;  // MXCSR: flags of what has happened in the lowest six bits
  static constexpr Control kDefault = 0x1f80, kFlags = 0x3f;
  static bool is_default(Control control) { return (control & ~kFlags) == kDefault; }
  static Control get() { return _mm_getcsr(); }
  static void set(Control control) { _mm_setcsr(control); }
#elif defined(__aarch64__) && defined(__GNUC__)
  using Control = std::uint64_t;  // FPCR; flags have a register of their own
  static constexpr Control kDefault = 0;
  static bool is_default(Control control) { return control == kDefault; }
  static Control get() {
    Control control;
    asm volatile("mrs %0, fpcr" : "=r"(control));
    return control;
  }
  static void set(Control control) { asm volatile("msr fpcr, %0" : : "r"(control)); }
#else
  // WebAssembly has one mode only; elsewhere the caller is trusted.
  using Control = std::uint32_t;
  static constexpr Control kDefault = 0;
  static bool is_default(Control) { return true; }
  static Control get() { return kDefault; }
  static void set(Control) {}
#endif

  // The compiler knows nothing of modes: what comes from memory is read after this, what goes there
  // is written before.
  static void keep_order() {
#if defined(__GNUC__)
    asm volatile("" : : : "memory");
#endif
  }

  Control before_;
};

}  // namespace pierce
