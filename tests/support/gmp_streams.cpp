// SPDX-License-Identifier: Apache-2.0
//
// How GoogleTest prints the numbers of GMP. The installed libgmpxx does that for the standard
// library that it was compiled with, and for no other; there, this takes its place.
#include <gmpxx.h>

#include <ostream>
#include <string>

std::ostream& operator<<(std::ostream& out, mpz_srcptr x) {
  std::string digits(mpz_sizeinbase(x, 10) + 2, '\0');  // a sign, and the end
  return out << mpz_get_str(digits.data(), 10, x);
}

std::ostream& operator<<(std::ostream& out, mpq_srcptr x) {
  const std::size_t digits = mpz_sizeinbase(mpq_numref(x), 10) + mpz_sizeinbase(mpq_denref(x), 10);
  std::string text(digits + 3, '\0');  // a sign, a slash, and the end
  return out << mpq_get_str(text.data(), 10, x);
}
