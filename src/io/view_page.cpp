// SPDX-License-Identifier: Apache-2.0
#include "io/view_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>

#include "io/json_writer.h"
#include "io/view_template.h"
#include "pierce/error.h"

namespace pierce::io {
namespace {

using Write = std::function<void(std::string_view)>;

// Bytes to base64 (RFC 4648), three at a time however they come.
class Base64Writer {
 public:
  explicit Base64Writer(const Write& write) : write_(write) {}

  void add(std::span<const std::byte> bytes) {
    for (const std::byte byte : bytes) {
      rest_ = rest_ << 8U | static_cast<std::uint32_t>(byte);
      if (++count_ == 3) put(4);
    }
  }
  // Call last.
  void finish() {
    if (count_ != 0) {
      const unsigned missing = 3 - count_;
      rest_ <<= 8 * missing;
      put(4 - missing);
      out_.append(missing, '=');
    }
    write_(out_);
  }

 private:
  void put(unsigned digits) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (unsigned i = 0; i < digits; ++i) out_ += kDigits[rest_ >> (18 - 6 * i) & 63U];
    rest_ = count_ = 0;
    if (out_.size() < std::size_t{1} << 20) return;
    write_(out_);
    out_.clear();
  }

  const Write& write_;
  std::string out_;
  std::uint32_t rest_ = 0;
  unsigned count_ = 0;
};

// Arrays one after the other, each from a multiple of eight on.
class Block {
 public:
  // Returns what the facts say of it.
  template <class Number>
  std::vector<std::uint64_t> add(std::span<const Number> numbers) {
    const auto [known, is_new] = places_.try_emplace(
        {numbers.data(), numbers.size_bytes()}, std::vector<std::uint64_t>{size_, numbers.size()});
    if (is_new) {
      parts_.push_back(std::as_bytes(numbers));
      size_ += (numbers.size_bytes() + 7) & ~std::uint64_t{7};
    }
    return known->second;
  }
  void write(Base64Writer& out) const {
    constexpr std::byte kZeros[8] = {};
    for (const auto& part : parts_) {
      out.add(part);
      out.add(std::span(kZeros).first((8 - part.size() % 8) % 8));
    }
  }

 private:
  std::vector<std::span<const std::byte>> parts_;
  std::map<std::pair<const void*, std::size_t>, std::vector<std::uint64_t>> places_;
  std::uint64_t size_ = 0;
};

template <class Number, class Row>
std::span<const Number> numbers_of(std::span<const Row> rows) {
  static_assert(sizeof(Row) % sizeof(Number) == 0);
  return {reinterpret_cast<const Number*>(rows.data()),
          rows.size() * (sizeof(Row) / sizeof(Number))};
}

template <class Real>
void check(const ViewContent<Real>& content) {
  for (const auto& [name, mesh, place] : content.meshes) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const Triangle& t = mesh.triangles[i];
      if (std::max({t[0], t[1], t[2]}) < mesh.vertices.size()) continue;
      throw Error(ErrorCode::IndexOutOfRange,
                  fmt::format("{}: triangle {} names a vertex beyond the {} that there are", name,
                              i, mesh.vertices.size()),
                  i);
    }
  }
  std::vector<MeshView<Real>> meshes;
  for (const auto& mesh : content.meshes) meshes.push_back(mesh.mesh);
  check_hits<Real>(content.hits, meshes);
}

// In an element of a page nothing may look like the end of it.
std::string within_page(const std::string& json) {
  std::string text;
  for (const char c : json) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

}  // namespace

template <class Real>
void check_hits(std::span<const ViewHit<Real>> hits, std::span<const MeshView<Real>> meshes) {
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const auto [ray, geometry, triangle] = hits[i].names;
    if (triangle == kNone) continue;
    if (geometry < meshes.size() && triangle < meshes[geometry].triangles.size()) continue;
    throw Error(ErrorCode::IndexOutOfRange,
                fmt::format("hit {} is on triangle {} of geometry {}, which is not there: give the "
                            "hits of these meshes",
                            i, triangle, geometry),
                i);
  }
}

template <class Real>
void write_view_page(const ViewContent<Real>& content, const Write& write) {
  check(content);
  std::vector<Real> numbers;
  std::vector<std::uint32_t> names;
  for (const auto& hit : content.hits) {
    numbers.insert(numbers.end(), hit.numbers.begin(), hit.numbers.end());
    names.insert(names.end(), hit.names.begin(), hit.names.end());
  }
  Block block;
  JsonWriter facts;
  facts.open_object();
  facts.value("title", content.title);
  facts.value("bits", 8 * sizeof(Real));
  facts.value("up", content.z_up ? "z" : "y");
  facts.open_array("meshes");
  for (const auto& [name, mesh, place] : content.meshes) {
    facts.open_object();
    facts.value("name", name);
    facts.values("vertices", block.add(numbers_of<Real>(mesh.vertices)));
    facts.values("triangles", block.add(numbers_of<std::uint32_t>(mesh.triangles)));
    if (place != nullptr) {
      const Real* first = place->rows[0].data();
      facts.values("matrix", std::vector<Real>(first, first + 12));
    }
    facts.close_object();
  }
  facts.close_array();
  facts.values("rays", block.add(numbers_of<Real>(content.rays)));
  facts.values("hits", block.add(std::span<const Real>(numbers)));
  facts.values("names", block.add(std::span<const std::uint32_t>(names)));
  facts.close_object();

  const std::string_view page = kViewTemplate;
  constexpr std::string_view kPlace = "<!--data-->";
  const std::size_t at = page.find(kPlace);
  write(page.substr(0, at));
  write("<script id=\"facts\" type=\"application/json\">");
  write(within_page(facts.text()));
  write("</script>\n<script id=\"bytes\" type=\"text/plain\">");
  Base64Writer base64(write);
  block.write(base64);
  base64.finish();
  write("</script>");
  write(page.substr(at + kPlace.size()));
}

template void check_hits(std::span<const ViewHit<float>>, std::span<const MeshView<float>>);
template void check_hits(std::span<const ViewHit<double>>, std::span<const MeshView<double>>);
template void write_view_page(const ViewContent<float>&, const Write&);
template void write_view_page(const ViewContent<double>&, const Write&);

}  // namespace pierce::io
