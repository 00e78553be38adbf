// SPDX-License-Identifier: Apache-2.0
#include "scene/strided.h"

#include <limits>

namespace pierce::scene {

void validate_rows(const void* data, std::size_t count, const char* name) {
  if (count > static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max())) {
    throw Error(ErrorCode::InvalidArgument,
                "the number of rows of " + std::string(name) + " is negative; give 0 or more");
  }
  if (count != 0 && data == nullptr) {
    throw Error(ErrorCode::InvalidArgument, std::string(name) + " has " + std::to_string(count) +
                                                " rows but no data; point it at them");
  }
}

void BatchSize::add(const void* data, std::size_t count, const char* name) {
  validate_rows(data, count, name);
  if (count == 1) return;  // for all
  if (name_ == nullptr) {
    name_ = name;
    size_ = count;
  } else if (count != size_) {
    throw Error(ErrorCode::SizeMismatch, std::string(name_) + " has " + std::to_string(size_) +
                                             " rows but " + name + " has " + std::to_string(count) +
                                             "; give one a " + of_ + ", or one for all");
  }
}

template <class T>
OutputRows<T>::OutputRows(void* data, std::size_t count, std::ptrdiff_t stride, std::ptrdiff_t step,
                          std::size_t wanted, const char* of, const char* name)
    : data_(count == 0 ? nullptr : static_cast<std::byte*>(data)), stride_(stride), step_(step) {
  if (count == 0) return;  // not wanted
  validate_rows(data, count, name);
  if (count == wanted) return;
  throw Error(ErrorCode::SizeMismatch, "there are " + std::to_string(wanted) + " " + of + "s but " +
                                           name + " has " + std::to_string(count) +
                                           " rows; give it one a " + of + ", or none");
}

OutputIds::OutputIds(const IdRows& rows, std::size_t wanted, const char* of, const char* name) {
  if (rows.wide()) {
    wide_ = {rows.data(), rows.count(), rows.stride(), sizeof(std::int64_t), wanted, of, name};
  } else {
    narrow_ = {rows.data(), rows.count(), rows.stride(), sizeof(std::uint32_t), wanted, of, name};
  }
}

template class OutputRows<float>;
template class OutputRows<double>;
template class OutputRows<std::uint8_t>;
template class OutputRows<std::int8_t>;
template class OutputRows<std::uint32_t>;
template class OutputRows<std::int32_t>;
template class OutputRows<std::int64_t>;

}  // namespace pierce::scene
