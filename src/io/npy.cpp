// SPDX-License-Identifier: Apache-2.0
#include "io/npy.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>
#include <numeric>
#include <optional>

#include "io/bad_file.h"
#include "io/output_file.h"
#include "io/python_literal.h"

namespace pierce::io {
namespace {

constexpr std::string_view kNpyMagic = "\x93NUMPY";
constexpr std::size_t kPreludeBytes = 12;  // magic, two version bytes, the header's length

struct Prelude {
  std::size_t dictionary_at = 0;  // 0: no .npy file of a known version
  std::size_t dictionary_bytes = 0;
};

Prelude parse_prelude(std::string_view bytes) {
  if (bytes.size() < 10 || !bytes.starts_with(kNpyMagic)) return {};
  const auto byte = [&](std::size_t i) {
    return std::size_t{static_cast<unsigned char>(bytes[i])};
  };
  const std::size_t version = byte(6);
  if (version == 1) return {10, byte(8) | byte(9) << 8};
  if ((version != 2 && version != 3) || bytes.size() < kPreludeBytes) return {};
  return {kPreludeBytes, byte(8) | byte(9) << 8 | byte(10) << 16 | byte(11) << 24};
}

class HeaderReader {
 public:
  HeaderReader(std::string_view text, const std::string& name) : literal_(text, name) {}

  NpyHeader read() {
    NpyHeader header;
    bool has_descr = false, has_order = false, has_shape = false;
    literal_.expect('{');
    while (!literal_.take('}')) {
      const std::string key = literal_.string();
      literal_.expect(':');
      if ((key == "descr" && has_descr) || (key == "fortran_order" && has_order) ||
          (key == "shape" && has_shape)) {
        literal_.fail(fmt::format("{} is there twice", key));
      }
      if (key == "descr") {
        read_descr(header);
        has_descr = true;
      } else if (key == "fortran_order") {
        header.fortran_order = literal_.boolean();
        has_order = true;
      } else if (key == "shape") {
        header.shape = literal_.tuple();
        has_shape = true;
      } else {
        literal_.fail(fmt::format("unknown key {}", in_quotes(key)));
      }
      if (!literal_.take(',')) {
        literal_.expect('}');
        break;
      }
    }
    if (!has_descr || !has_order || !has_shape) {
      literal_.fail("descr, fortran_order or shape is missing");
    }
    check_size(header);
    return header;
  }

 private:
  void read_descr(NpyHeader& header) {
    if (!literal_.take('[')) {
      header.fields.push_back(parse_type(literal_.string()));
      header.element_bytes = header.fields[0].bytes;
      return;
    }
    header.structured = true;
    while (!literal_.take(']')) {
      literal_.expect('(');
      const std::string field_name = read_field_name();
      literal_.expect(',');
      if (literal_.peek() == '[') literal_.fail("a structure inside a structure is not read");
      NpyField field = parse_type(literal_.string());
      field.name = field_name;
      if (literal_.take(',') && literal_.peek() == '(') {
        for (const std::uint64_t n : literal_.tuple()) field.repeat = times(field.repeat, n);
        literal_.take(',');
      }
      literal_.expect(')');
      field.offset = header.element_bytes;
      const std::size_t bytes = times(field.bytes, field.repeat);
      if (bytes > std::numeric_limits<std::size_t>::max() - header.element_bytes) fail_size();
      header.element_bytes += bytes;
      header.fields.push_back(std::move(field));
      if (!literal_.take(',')) {
        literal_.expect(']');
        break;
      }
    }
  }

  // A name, or a pair of a title and a name.
  std::string read_field_name() {
    if (!literal_.take('(')) return literal_.string();
    (void)literal_.string();
    literal_.expect(',');
    std::string field_name = literal_.string();
    literal_.expect(')');
    return field_name;
  }

  // Byte order, kind, bytes: "<f4". '|' and '=' mean that the order does not matter or is ours.
  NpyField parse_type(const std::string& text) {
    NpyField field;
    std::string_view rest = text;
    if (!rest.empty() && std::string_view("<>|=").find(rest[0]) != rest.npos) {
      field.big_endian = rest[0] == '>';
      rest.remove_prefix(1);
    }
    if (rest == "O") {  // Python objects
      field.kind = 'O';
      field.bytes = sizeof(std::uint64_t);
      return field;
    }
    if (rest.size() < 2) literal_.fail(fmt::format("unknown number type {}", in_quotes(text)));
    field.kind = rest[0];
    rest.remove_prefix(1);
    for (const char c : rest) {
      if (c < '0' || c > '9' || field.bytes > 100'000'000) {
        literal_.fail(fmt::format("unknown number type {}", in_quotes(text)));
      }
      field.bytes = 10 * field.bytes + static_cast<std::size_t>(c - '0');
    }
    if (field.kind == 'U') field.bytes *= 4;  // counted in characters
    return field;
  }

  [[noreturn]] void fail_size() const { literal_.fail("more bytes than 64 bits can count"); }

  std::uint64_t times(std::uint64_t a, std::uint64_t b) const {
    std::uint64_t product = 0;
    if (__builtin_mul_overflow(a, b, &product)) fail_size();
    return product;
  }

  void check_size(const NpyHeader& header) const {
    // An extent of 0 must not hide the size of the others.
    std::uint64_t bytes = header.element_bytes;
    for (const std::uint64_t n : header.shape) bytes = times(bytes, n == 0 ? 1 : n);
    if (bytes > std::uint64_t{std::numeric_limits<std::int64_t>::max()}) fail_size();
  }

  PythonLiteral literal_;
};

}  // namespace

std::uint64_t NpyHeader::count() const {
  return std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies<>());
}

std::size_t npy_header_bytes(std::string_view first_bytes) {
  const Prelude prelude = parse_prelude(first_bytes);
  return prelude.dictionary_at + prelude.dictionary_bytes;
}

NpyHeader parse_npy_header(std::string_view bytes, const std::string& name) {
  const Prelude prelude = parse_prelude(bytes);
  if (prelude.dictionary_at == 0) {
    bad_file(name, "is no .npy file of version 1, 2 or 3: write it with numpy.save");
  }
  const std::size_t end = prelude.dictionary_at + prelude.dictionary_bytes;
  if (bytes.size() < end) bad_file(name, "ends inside the .npy header: it was cut off");
  NpyHeader header =
      HeaderReader(bytes.substr(prelude.dictionary_at, prelude.dictionary_bytes), name).read();
  header.data_offset = end;
  return header;
}

std::string make_npy_header(std::string_view descr, std::span<const std::uint64_t> shape) {
  // A one-tuple needs its comma. Room is left for the longest count, and the data is aligned.
  constexpr std::size_t kAlignment = 64;
  const std::string dictionary =
      fmt::format("{{'descr': {}, 'fortran_order': False, 'shape': ({}{}), }}", descr,
                  fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
  std::size_t shortest = dictionary.size();
  for (const std::uint64_t n : shape) shortest -= fmt::formatted_size("{}", n);
  constexpr std::size_t kVersion1Bytes = 10;
  constexpr std::size_t kLongestCount = 20;
  const std::size_t room = kVersion1Bytes + shortest + kLongestCount * shape.size() + 1;
  const std::size_t total = (room + kAlignment - 1) / kAlignment * kAlignment;
  const std::size_t length = total - kVersion1Bytes;
  std::string header(kNpyMagic);
  header += {'\x01', '\x00', static_cast<char>(length & 0xff), static_cast<char>(length >> 8)};
  header += dictionary;
  header.resize(total - 1, ' ');
  return header + '\n';
}

void write_npy(const std::filesystem::path& path, std::string_view descr,
               std::span<const std::uint64_t> shape, std::string_view bytes) {
  OutputFile file(path);
  file.write(make_npy_header(descr, shape));
  file.write(bytes);
  file.commit();
}

}  // namespace pierce::io
