// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>

#include "io/bad_file.h"
#include "io/gltf_file.h"
#include "io/mesh_parts.h"

namespace pierce::io {
namespace {

constexpr unsigned kFloat = 5126;

unsigned size_of(unsigned type) {
  switch (type) {
    case 5120:
    case 5121:
      return 1;
    case 5122:
    case 5123:
      return 2;
    case 5125:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

template <class Number>
Number load(const char* at) {
  std::array<char, sizeof(Number)> raw;
  std::memcpy(raw.data(), at, sizeof(Number));
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  return std::bit_cast<Number>(raw);
}

double load_number(const char* at, unsigned type) {
  switch (type) {
    case 5120:
      return load<std::int8_t>(at);
    case 5121:
      return load<std::uint8_t>(at);
    case 5122:
      return load<std::int16_t>(at);
    case 5123:
      return load<std::uint16_t>(at);
    case 5125:
      return load<std::uint32_t>(at);
    default:
      return static_cast<double>(load<float>(at));
  }
}

// What stands for 1 if the integers are normalised.
double largest_of(unsigned type) {
  constexpr std::array<double, 6> kLargest = {127, 255, 32767, 65535, 2147483647, 4294967295};
  return type < kFloat ? kLargest[type - 5120] : 1;
}

unsigned components_of(std::string_view type) {
  constexpr std::array<std::pair<std::string_view, unsigned>, 7> kTypes = {{{"SCALAR", 1},
                                                                            {"VEC2", 2},
                                                                            {"VEC3", 3},
                                                                            {"VEC4", 4},
                                                                            {"MAT2", 4},
                                                                            {"MAT3", 9},
                                                                            {"MAT4", 16}}};
  for (const auto& [name, components] : kTypes) {
    if (type == name) return components;
  }
  return 0;
}

unsigned type_of(const JsonView& holder) {
  const JsonView at = holder.at("componentType");
  const auto type = static_cast<unsigned>(at.whole(100000));
  if (size_of(type) == 0) at.fail(fmt::format("{} is no type of numbers: correct it", type));
  return type;
}

void normalize(const JsonView& accessor, unsigned type, std::vector<double>& numbers) {
  if (!accessor.flag("normalized") || type == kFloat) return;
  for (double& x : numbers) x = std::max(x / largest_of(type), -1.0);
}

}  // namespace

// Rows of numbers in bytes.
struct GltfFile::Columns {
  std::string_view bytes;
  std::uint64_t stride;
  unsigned type, components;

  // Throws Error unless there are `count` rows from `offset` on.
  Columns(const View& view, std::uint64_t offset, std::uint64_t count, unsigned number_type,
          unsigned wide, const JsonView& holder)
      : type(number_type), components(wide) {
    const std::uint64_t row = std::uint64_t{size_of(type)} * components;
    stride = view.stride == 0 ? row : view.stride;
    const std::uint64_t size = view.bytes.size();
    const bool fits =
        stride >= row && offset <= size &&
        (count == 0 || (size - offset >= row && (count - 1) <= (size - offset - row) / stride));
    if (!fits) {
      holder.fail(
          fmt::format("{} values do not fit its view of {} bytes: the file was cut off or "
                      "damaged",
                      count, size));
    }
    bytes = view.bytes.substr(offset);
  }

  [[nodiscard]] double at(std::uint64_t row, unsigned k) const {
    return load_number(bytes.data() + row * stride + std::uint64_t{k} * size_of(type), type);
  }
};

std::vector<double> GltfFile::raw_numbers(const JsonView& accessor, unsigned components) {
  const unsigned type = type_of(accessor);
  const std::uint64_t count = accessor.at("count").whole(kMaxVertices);
  const JsonView kind = accessor.at("type");
  if (components_of(kind.text()) != components) {
    kind.fail(fmt::format("{} in place of {} numbers a value: correct it", in_quotes(kind.text()),
                          components));
  }
  std::vector<double> numbers;
  const std::optional<JsonView> data = accessor.find("bufferView");
  if (data) {
    const Columns columns(view(*data), accessor.whole("byteOffset", 0), count, type, components,
                          accessor);
    numbers.reserve(count * components);
    for (std::uint64_t i = 0; i < count; ++i) {
      for (unsigned k = 0; k < components; ++k) numbers.push_back(columns.at(i, k));
    }
  } else {
    // Zeros that take no room in the file.
    constexpr std::uint64_t kMostZeros = std::uint64_t{1} << 24;
    if (count > kMostZeros) accessor.fail(fmt::format("{} values without data: correct it", count));
    numbers.resize(count * components);
  }
  const std::optional<JsonView> sparse = accessor.find("sparse");
  if (sparse) {
    const JsonView values = sparse->at("values");
    const Columns columns(view(values.at("bufferView")), values.whole("byteOffset", 0),
                          sparse->at("count").whole(count), type, components, values);
    replace_sparse(*sparse, columns, numbers);
  }
  return numbers;
}

void GltfFile::replace_sparse(const JsonView& sparse, const Columns& values,
                              std::vector<double>& numbers) {
  const std::uint64_t count = sparse.at("count").whole();
  const JsonView places = sparse.at("indices");
  const unsigned type = type_of(places);
  if (type == kFloat) places.fail("indices that are floats: correct it");
  const Columns rows(view(places.at("bufferView")), places.whole("byteOffset", 0), count, type, 1,
                     places);
  const std::uint64_t all = numbers.size() / values.components;
  for (std::uint64_t i = 0; i < count; ++i) {
    const double row = rows.at(i, 0);
    if (!(row >= 0 && row < static_cast<double>(all))) {
      places.fail(fmt::format("index {} names value {}, {}: correct it", i, row, there_are(all)),
                  i);
    }
    for (unsigned k = 0; k < values.components; ++k) {
      numbers[static_cast<std::uint64_t>(row) * values.components + k] = values.at(i, k);
    }
  }
}

GltfNumbers GltfFile::numbers(const JsonView& index, unsigned components) {
  const JsonView accessor = document().named("accessors", index);
  GltfNumbers out;
  out.numbers = raw_numbers(accessor, components);
  out.count = out.numbers.size() / components;
  const unsigned type = type_of(accessor);
  out.floats = type == kFloat;
  normalize(accessor, type, out.numbers);
  return out;
}

GltfNumbers GltfFile::numbers(const JsonView& index, unsigned components,
                              const DracoAttribute& attribute) const {
  const JsonView accessor = document().named("accessors", index);
  if (attribute.type == 0 || attribute.components != components) {
    accessor.fail("the Draco data are of another type: the file was damaged");
  }
  GltfNumbers out;
  out.floats = attribute.type == kFloat;
  const unsigned size = size_of(attribute.type);
  out.count = attribute.bytes.size() / (std::uint64_t{size} * components);
  for (std::size_t at = 0; at < attribute.bytes.size(); at += size) {
    out.numbers.push_back(load_number(attribute.bytes.data() + at, attribute.type));
  }
  normalize(accessor, attribute.type, out.numbers);
  return out;
}

std::vector<std::uint32_t> GltfFile::indices(const JsonView& index) {
  const JsonView accessor = document().named("accessors", index);
  const unsigned type = type_of(accessor);
  if (type == kFloat || accessor.flag("normalized")) {
    accessor.fail("indices must be whole numbers: correct it");
  }
  const std::vector<double> numbers = raw_numbers(accessor, 1);
  std::vector<std::uint32_t> out;
  out.reserve(numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] < 0) accessor.fail(fmt::format("index {} is {}: correct it", i, numbers[i]), i);
    out.push_back(static_cast<std::uint32_t>(numbers[i]));
  }
  return out;
}

bool GltfFile::has_data(const JsonView& index) const {
  const JsonView accessor = document().named("accessors", index);
  return accessor.has("bufferView") || accessor.has("sparse");
}

}  // namespace pierce::io
