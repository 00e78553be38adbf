// SPDX-License-Identifier: Apache-2.0
//
// The floating-point mode that all proofs of this library suppose: results rounded to nearest,
// denormal numbers kept, no traps. A caller may have another one (-ffast-math flushes denormals to
// zero from the start of the program); its threads, too.
#pragma once

#include <cstdint>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace pierce {

/// The default mode for as long as this object lives; then the mode from before, if that was
/// another. A nanosecond where it is the default already.
class FloatEnvironment {
 public:
  FloatEnvironment() {
    if (!is_default()) [[unlikely]] {
      before_ = get();
      set(kDefault);
      changed_ = true;
    }
    keep_order();
  }
  ~FloatEnvironment() {
    keep_order();
    if (changed_) [[unlikely]]
      set(before_);
  }
  /// What is to be returned, made while this object lives: a number that nothing has written to
  /// memory yet might else be computed after the mode from before is back.
  template <class T>
  [[nodiscard]] T made(T value) const {
#if defined(__GNUC__)
    asm volatile("" : : "r"(&value) : "memory");
#endif
    return value;
  }

  FloatEnvironment(const FloatEnvironment&) = delete;
  FloatEnvironment& operator=(const FloatEnvironment&) = delete;

 private:
#if defined(__SSE2__) && defined(__GNUC__)
  using Control = std::uint32_t;  // MXCSR
  static constexpr Control kDefault = 0x1f80;
  static Control get() { return _mm_getcsr(); }
  static void set(Control control) { _mm_setcsr(control); }
  /// Asks by an addition: to read MXCSR is to wait for all that was computed before, which costs 3
  /// to 4 % of a ray, where this costs less than 1 %.
  static bool is_default() {
    constexpr float kTiny = 0x1p-149F, kHalfUlp = 0x1p-25F;
    __m128 sum = _mm_setr_ps(1, 1, kTiny, -1);
    asm volatile("" : "+x"(sum));  // not to be computed by the compiler
    const __m128 expected = sum;
    // Upwards, 1 + x is more than 1; downwards and to zero, 1 - x is less; flushed, kTiny is 0.
    sum = _mm_add_ps(sum, _mm_setr_ps(kHalfUlp, -kHalfUlp / 2, 0, kHalfUlp / 2));
    return _mm_movemask_epi8(_mm_cmpeq_epi32(_mm_castps_si128(sum), _mm_castps_si128(expected))) ==
           0xffff;
  }
#elif defined(__aarch64__) && defined(__GNUC__)
  using Control = std::uint64_t;  // FPCR
  static constexpr Control kDefault = 0;
  static Control get() {
    Control control;
    asm volatile("mrs %0, fpcr" : "=r"(control));
    return control;
  }
  static void set(Control control) { asm volatile("msr fpcr, %0" : : "r"(control)); }
  static bool is_default() { return get() == kDefault; }
#else
  // WebAssembly has one mode only; elsewhere the caller is trusted.
  using Control = std::uint32_t;
  static constexpr Control kDefault = 0;
  static Control get() { return kDefault; }
  static void set(Control) {}
  static bool is_default() { return true; }
#endif

  // The compiler knows nothing of modes: what comes from memory is read after this, what goes there
  // is written before.
  static void keep_order() {
#if defined(__GNUC__)
    asm volatile("" : : : "memory");
#endif
  }

  Control before_ = kDefault;
  bool changed_ = false;
};

}  // namespace pierce
