// SPDX-License-Identifier: Apache-2.0
#include "io/threemf_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "io/bad_file.h"
#include "io/mesh_parts.h"
#include "io/text_cursor.h"
#include "io/xml_reader.h"

namespace pierce::io {
namespace {

constexpr std::string_view kCore = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
constexpr std::string_view kProduction =
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";

struct Unit {
  ThreemfUnit unit;
  const char* name;  // as in the file
  double millimetres;
};
constexpr std::array<Unit, 6> kUnits = {{{ThreemfUnit::Micron, "micron", 0.001},
                                         {ThreemfUnit::Millimetre, "millimeter", 1},
                                         {ThreemfUnit::Centimetre, "centimeter", 10},
                                         {ThreemfUnit::Inch, "inch", 25.4},
                                         {ThreemfUnit::Foot, "foot", 304.8},
                                         {ThreemfUnit::Metre, "meter", 1000}}};

const Unit& unit_of(ThreemfUnit unit) { return kUnits[static_cast<std::size_t>(unit)]; }

// Extensions that say nothing of where the triangles are, and the one that is read.
bool is_known_space(std::string_view space) {
  return space == kCore || space == kProduction || space.find("/material/") != space.npos ||
         space.find("/trianglesets/") != space.npos;
}

class ModelParser {
 public:
  explicit ModelParser(const std::string& name) : name_(name) {}

  ThreemfModel parse(std::string_view text) {
    read_xml(text, name_,
             {[this](const XmlElement& element) { open(element); }, [this](XmlName) { close(); },
              [this](std::string_view prefix, std::string_view space) {
                prefixes_[std::string(prefix)] = space;
              }});
    return std::move(model_);
  }

 private:
  // What is in an unknown namespace is stepped over with all that it holds.
  void open(const XmlElement& element) {
    const XmlName name = element.name();
    line_ = element.line();
    if (is_root_ && (name.local != "model" || !(name.space == kCore || name.space.empty()))) {
      fail(fmt::format("the root is {} of {}, not the model of a 3MF: save the file anew",
                       in_quotes(name.local), in_quotes(name.space, 100)));
    }
    is_root_ = false;
    if (skipped_ > 0 || !(name.space == kCore || name.space.empty())) {
      ++skipped_;
      return;
    }
    if (name.local == "model") {
      read_model(element);
    } else if (name.local == "object") {
      object_ = &add_object(element);
    } else if (name.local == "vertex" && object_ != nullptr) {
      read_vertex(element);
    } else if (name.local == "triangle" && object_ != nullptr) {
      read_triangle(element);
    } else if (name.local == "component" && object_ != nullptr) {
      object_->components.push_back(read_component(element));
    } else if (name.local == "item") {
      model_.items.push_back(read_component(element));
    }
    open_.emplace_back(name.local);
  }

  void close() {
    if (skipped_ > 0) {
      --skipped_;
      return;
    }
    if (open_.back() == "object") finish_object();
    open_.pop_back();
  }

  void read_model(const XmlElement& element) {
    if (const auto unit = element.attribute("unit")) {
      bool known = false;
      for (const Unit& candidate : kUnits) {
        if (*unit != candidate.name) continue;
        model_.unit = candidate.unit;
        known = true;
      }
      if (!known) fail(fmt::format("{} is no unit of a 3MF: correct it", in_quotes(*unit)));
    }
    const auto required = element.attribute("requiredextensions");
    if (!required) return;
    TextCursor words(*required, name_);
    for (auto word = words.word(); !word.empty(); word = words.word()) {
      const auto found = prefixes_.find(std::string(word));
      const std::string space = found == prefixes_.end() ? std::string(word) : found->second;
      if (is_known_space(space)) continue;
      fail(
          fmt::format("the file cannot be read without the extension {}, which pierce does not "
                      "know: save it without",
                      in_quotes(space, 100)));
    }
  }

  ThreemfObject& add_object(const XmlElement& element) {
    const std::string id(needed(element, "id"));
    const auto [at, is_new] = model_.objects.try_emplace(id);
    if (!is_new) fail(fmt::format("a second object {}: rename one", in_quotes(id)));
    at->second.name = element.attribute("name").value_or("");
    const std::string_view type = element.attribute("type").value_or("model");
    at->second.is_aid = type == "other" || type == "support" || type == "solidsupport";
    return at->second;
  }

  void read_vertex(const XmlElement& element) {
    if (object_->vertices.size() == kMaxVertices) fail("more than 2^32 - 1 vertices: split it");
    object_->vertices.push_back({number(element, "x"), number(element, "y"), number(element, "z")});
  }

  // Vertices stand before triangles.
  void read_triangle(const XmlElement& element) {
    Triangle t{};
    constexpr std::array<const char*, 3> kKeys = {"v1", "v2", "v3"};
    for (std::size_t k = 0; k < 3; ++k) {
      const double index = number(element, kKeys[k]);
      const std::size_t count = object_->vertices.size();
      if (!(index >= 0 && index < static_cast<double>(count)) || index != std::trunc(index)) {
        fail(fmt::format("{} {} names no vertex, {}: correct it", kKeys[k],
                         in_quotes(needed(element, kKeys[k])), there_are(count)));
      }
      t[k] = static_cast<std::uint32_t>(index);
    }
    object_->triangles.push_back(t);
  }

  void finish_object() {
    if (object_ != nullptr && !object_->triangles.empty() && !object_->components.empty()) {
      fail("an object with a mesh and components: it can have one of them");
    }
    object_ = nullptr;
  }

  ThreemfComponent read_component(const XmlElement& element) {
    ThreemfComponent component;
    component.object = needed(element, "objectid");
    std::string_view path = element.attribute("path", kProduction).value_or("");
    while (path.starts_with('/')) path.remove_prefix(1);
    component.path = path;
    const auto transform = element.attribute("transform");
    if (!transform) return component;
    // Points are rows there: x y z 1 times four rows of three.
    TextCursor words(*transform, name_);
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t i = 0; i < 3; ++i) {
        words.skip_space();
        double& entry = component.matrix.rows[i][j];
        if (!parse_number(words.word(), entry) || !std::isfinite(entry)) fail_transform(*transform);
      }
    }
    words.skip_space();
    if (!words.at_end()) fail_transform(*transform);
    return component;
  }

  [[noreturn]] void fail_transform(std::string_view text) const {
    fail(fmt::format("the transform {} is not 12 numbers: correct it", in_quotes(text, 80)));
  }

  [[nodiscard]] std::string_view needed(const XmlElement& element, const char* key) const {
    const auto value = element.attribute(key);
    if (!value) {
      fail(fmt::format("{} without {}: complete it", in_quotes(element.name().local), key));
    }
    return *value;
  }

  [[nodiscard]] double number(const XmlElement& element, const char* key) const {
    const std::string_view text = needed(element, key);
    constexpr std::string_view kSpace = " \t\r\n";
    const std::size_t first = std::min(text.find_first_not_of(kSpace), text.size());
    const std::string_view trimmed = text.substr(first, text.find_last_not_of(kSpace) + 1 - first);
    double value = 0;
    if (!parse_number(trimmed, value)) {
      fail(fmt::format("{} is {}, no number that fits a double: {}", key, in_quotes(text),
                       number_cure(trimmed)));
    }
    return value;
  }

  [[noreturn]] void fail(std::string_view message) const { bad_line(name_, line_, message); }

  const std::string& name_;
  ThreemfModel model_;
  ThreemfObject* object_ = nullptr;
  std::vector<std::string> open_;
  std::map<std::string, std::string> prefixes_;
  std::uint64_t skipped_ = 0, line_ = 1;
  bool is_root_ = true;  // the next element
};

}  // namespace

const char* unit_name(ThreemfUnit unit) { return unit_of(unit).name; }
double millimetres(ThreemfUnit unit) { return unit_of(unit).millimetres; }

ThreemfModel parse_threemf_model(std::string_view text, const std::string& name) {
  return ModelParser(name).parse(text);
}

}  // namespace pierce::io
