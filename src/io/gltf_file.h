// SPDX-License-Identifier: Apache-2.0
//
// GltfFile: the document of a glTF 2.0 file and the data behind it: buffers, views, accessors.
// Source: Khronos, "glTF 2.0 Specification", and the extensions of its registry.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/gltf_codecs.h"
#include "io/json_view.h"
#include "io/mapped_file.h"

namespace pierce::io {

/// The values of an accessor, row by row: `components` doubles each. Integers are exact, normalised
/// ones the nearest double to their fraction.
struct GltfNumbers {
  std::vector<double> numbers;
  std::uint64_t count = 0;
  bool floats = false;  ///< the file holds 32-bit floats
};

class GltfFile {
 public:
  /// .gltf or .glb, whichever the bytes are. Throws Error (BadFile), also if the file requires an
  /// extension that is not known. Further files that it names are looked for beside `name`.
  GltfFile(std::string_view bytes, const std::string& name);

  [[nodiscard]] JsonView document() const { return {json_, name_}; }
  [[nodiscard]] bool binary() const { return is_binary_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// A line each, without the name.
  std::vector<std::string> warnings;

  /// The accessor that `index` names.
  [[nodiscard]] GltfNumbers numbers(const JsonView& index, unsigned components);
  [[nodiscard]] std::vector<std::uint32_t> indices(const JsonView& index);
  /// Whether the accessor has data of its own (and not only a compressed mesh's).
  [[nodiscard]] bool has_data(const JsonView& index) const;
  /// A Draco mesh's, which go by the accessor's type.
  [[nodiscard]] GltfNumbers numbers(const JsonView& index, unsigned components,
                                    const DracoAttribute& attribute) const;

  /// The bytes of a view that is not of an accessor.
  [[nodiscard]] std::string_view view_bytes(const JsonView& index);

 private:
  struct View {
    std::string_view bytes;
    std::uint64_t stride = 0;  ///< 0: as close as they can be
  };
  struct Columns;

  void read_container(std::string_view bytes);
  void check_extensions() const;
  [[nodiscard]] std::string_view buffer(const JsonView& index);
  [[nodiscard]] std::string_view load_buffer(const JsonView& buffer, std::uint64_t index);
  [[nodiscard]] View view(const JsonView& index);
  [[nodiscard]] View decoded_view(const JsonView& extension, std::uint64_t index);
  [[nodiscard]] std::vector<double> raw_numbers(const JsonView& accessor, unsigned components);
  void replace_sparse(const JsonView& accessor, const Columns& columns,
                      std::vector<double>& numbers);

  const std::string& name_;
  nlohmann::json json_;
  std::string_view chunk_;  // the binary one of a .glb
  bool is_binary_ = false, has_chunk_ = false;
  std::map<std::uint64_t, std::string_view> buffers_;
  std::map<std::uint64_t, std::string> decoded_buffers_, decoded_views_;
  std::vector<std::unique_ptr<MappedFile>> files_;
};

}  // namespace pierce::io
