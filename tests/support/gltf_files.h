// SPDX-License-Identifier: Apache-2.0
//
// Makes glTF files: bytes become buffer views and accessors, in whatever container.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "support/io_files.h"

namespace pierce::io {

inline std::string base64(const std::string& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t block = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      block = block << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (unsigned k = 0; k < 4; ++k) {
      out += i + k <= bytes.size() ? kDigits[block >> (18 - 6 * k) & 63] : '=';
    }
  }
  return out;
}

class GltfMaker {
 public:
  std::string nodes = R"([{"mesh":0}])";
  std::string scenes = R"("scene":0,"scenes":[{"nodes":[0]}])";  ///< empty: none
  std::string meshes;
  std::string extensions;  ///< "extensionsRequired":[...]
  std::string second_buffer;

  /// The number of the view; `more` are members of it.
  std::size_t view(const std::string& data, const std::string& more = {}) {
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    views_ += (views_.empty() ? "{" : ",{");
    views_ += "\"buffer\":0,\"byteOffset\":" + std::to_string(bytes_.size()) +
              ",\"byteLength\":" + std::to_string(data.size()) + more + "}";
    bytes_ += data;
    return view_count_++;
  }
  /// A view given as it stands.
  std::size_t plain_view(const std::string& json) {
    views_ += (views_.empty() ? "" : ",");
    views_ += json;
    return view_count_++;
  }
  std::size_t accessor(const std::string& json) {
    accessors_ += (accessors_.empty() ? "{" : ",{");
    accessors_ += json + "}";
    return accessor_count_++;
  }
  std::size_t accessor(std::size_t view, int type, std::size_t count, const char* kind,
                       const std::string& more = {}) {
    return accessor("\"bufferView\":" + std::to_string(view) +
                    ",\"componentType\":" + std::to_string(type) +
                    ",\"count\":" + std::to_string(count) + ",\"type\":\"" + kind + "\"" + more);
  }
  std::size_t bytes() const { return bytes_.size(); }

  /// One mesh of one primitive, whose members these are.
  void primitive(const std::string& members) { meshes = "[{\"primitives\":[{" + members + "}]}]"; }

  std::string in_text() const { return json("\"uri\":\"" + uri() + "\","); }
  std::string beside(const std::string& file) const { return json("\"uri\":\"" + file + "\","); }
  std::string binary() const {
    std::string text = json("");
    text.append((4 - text.size() % 4) % 4, ' ');
    std::string data = bytes_;
    data.append((4 - data.size() % 4) % 4, '\0');
    const auto text_bytes = static_cast<std::uint32_t>(text.size());
    const auto data_bytes = static_cast<std::uint32_t>(data.size());
    return "glTF" + little(2u, 28 + text_bytes + data_bytes, text_bytes) + "JSON" + text +
           little(data_bytes) + std::string("BIN\0", 4) + data;
  }
  const std::string& data() const { return bytes_; }

 private:
  std::string uri() const { return "data:application/octet-stream;base64," + base64(bytes_); }
  std::string json(const std::string& source) const {
    std::string out = R"({"asset":{"version":"2.0"},)";
    if (!scenes.empty()) out += scenes + ",";
    if (!extensions.empty()) out += extensions + ",";
    if (!nodes.empty()) out += "\"nodes\":" + nodes + ",";
    out += "\"meshes\":" + meshes + ",\"buffers\":[{" + source +
           "\"byteLength\":" + std::to_string(bytes_.size()) + "}" + second_buffer + "]";
    out += ",\"bufferViews\":[" + views_ + "],\"accessors\":[" + accessors_ + "]}";
    return out;
  }

  std::string bytes_, views_, accessors_;
  std::size_t view_count_ = 0, accessor_count_ = 0;
};

/// The triangle (0.1 0 0) (1 0 0) (0 1 0), indexed.
inline GltfMaker one_triangle() {
  GltfMaker maker;
  maker.accessor(maker.view(little(0.1f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f)), 5126, 3,
                 "VEC3");
  maker.accessor(maker.view(little(std::uint16_t{0}, std::uint16_t{1}, std::uint16_t{2})), 5123, 3,
                 "SCALAR");
  maker.primitive(R"("attributes":{"POSITION":0},"indices":1)");
  return maker;
}

}  // namespace pierce::io
