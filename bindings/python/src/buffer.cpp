// SPDX-License-Identifier: Apache-2.0
#include "buffer.h"

#include <bit>
#include <cstring>

namespace pierce::python {

Buffer::Buffer(nb::handle array, const char* name, Access access) : name_(name) {
  if (array.is_none()) return;
  const int flags = PyBUF_STRIDES | PyBUF_FORMAT | (access == Access::Write ? PyBUF_WRITABLE : 0);
  if (PyObject_GetBuffer(array.ptr(), &view_, flags) != 0) throw nb::python_error();
  given_ = true;
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  if (this != &other) {
    if (given_) PyBuffer_Release(&view_);
    view_ = other.view_;
    name_ = other.name_;
    given_ = std::exchange(other.given_, false);
  }
  return *this;
}

Buffer::~Buffer() {
  if (given_) PyBuffer_Release(&view_);
}

Buffer::Kind Buffer::kind() const {
  const char* format = view_.format != nullptr ? view_.format : "B";
  // '^' marks numbers that are not aligned; '<' and '>' the byte order, which must be this
  // machine's.
  constexpr char kForeign = std::endian::native == std::endian::little ? '>' : '<';
  if (*format == kForeign || *format == '!') return Kind::Other;
  if (std::strchr("@=^<>", *format) != nullptr && *format != '\0') ++format;
  // "?" are numpy.bool_: as good as bytes.
  if (std::strlen(format) != 1) return Kind::Other;
  if (std::strchr("fd", *format) != nullptr) return Kind::Float;
  if (std::strchr("bhilqn", *format) != nullptr) return Kind::Signed;
  if (std::strchr("BHILQN?", *format) != nullptr) return Kind::Unsigned;
  return Kind::Other;
}

void Buffer::check(Kind wanted, std::size_t size, int components) const {
  if (kind() != wanted || view_.itemsize != static_cast<Py_ssize_t>(size)) {
    throw nb::type_error(
        (std::string(name_) + " has another type of number than expected").c_str());
  }
  const bool columns = components > 0;
  if (view_.ndim != (columns ? 2 : 1) || (columns && view_.shape[1] != components)) {
    throw nb::value_error((std::string(name_) + " has another shape than expected").c_str());
  }
}

void Buffer::check_packed(std::size_t row, std::size_t alignment) const {
  const bool packed = view_.shape[0] <= 1 || view_.strides[0] == static_cast<Py_ssize_t>(row);
  const bool dense = view_.ndim == 1 || view_.shape[1] <= 1 || view_.strides[1] == view_.itemsize;
  if (!packed || !dense || reinterpret_cast<std::uintptr_t>(view_.buf) % alignment != 0) {
    throw nb::value_error((std::string(name_) + " does not lie in one piece").c_str());
  }
}

}  // namespace pierce::python
