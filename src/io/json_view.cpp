// SPDX-License-Identifier: Apache-2.0
#include "io/json_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/bad_file.h"

namespace pierce::io {

bool JsonView::has(const char* key) const { return value_->is_object() && value_->contains(key); }

std::optional<JsonView> JsonView::find(const char* key) const {
  if (!has(key)) return std::nullopt;
  JsonView found = *this;
  found.value_ = &value_->at(key);
  if (!where_.empty()) found.where_ += '.';
  found.where_ += key;
  return found;
}

JsonView JsonView::at(const char* key) const {
  std::optional<JsonView> found = find(key);
  if (!found) fail(fmt::format("lacks '{}': complete it", key));
  return *std::move(found);
}

JsonView JsonView::at(std::uint64_t index) const {
  if (index >= size()) fail(fmt::format("item {} is not there: complete it", index));
  JsonView found = *this;
  found.value_ = &(*value_)[index];
  found.where_ += fmt::format("[{}]", index);
  return found;
}

JsonView JsonView::named(const char* list, const JsonView& index) const {
  const std::uint64_t i = index.whole();
  const std::optional<JsonView> items = find(list);
  const std::uint64_t count = items ? items->size() : 0;
  if (i >= count) {
    index.fail(fmt::format("names {} {}, {}: correct it", list, i, there_are(count)), i);
  }
  return items->at(i);
}

std::uint64_t JsonView::size() const {
  if (!value_->is_array()) fail("expected an array: correct it");
  return value_->size();
}

std::uint64_t JsonView::whole(std::uint64_t largest) const {
  if (value_->is_number_unsigned() && value_->get<std::uint64_t>() <= largest)
    return value_->get<std::uint64_t>();
  // Some writers write 3.0.
  const double number = value_->is_number() ? value_->get<double>() : -1;
  const std::uint64_t most = std::min(largest, kLargest);
  if (!(number >= 0) || number > static_cast<double>(most) || number != std::trunc(number)) {
    if (number > static_cast<double>(most))
      fail(fmt::format("expected a whole number of at most {}, found {}: correct it", most,
                       in_quotes(value_->dump())));
    // Arrays within arrays within arrays are not written out: that takes a stack as deep.
    fail(fmt::format(
        "expected a whole number, found {}: correct it",
        value_->is_structured()
            ? value_->type_name()
            : in_quotes(value_->dump(-1, ' ', true, nlohmann::json::error_handler_t::replace))));
  }
  return static_cast<std::uint64_t>(number);
}

std::uint64_t JsonView::whole(const char* key, std::uint64_t otherwise) const {
  const std::optional<JsonView> found = find(key);
  return found ? found->whole() : otherwise;
}

double JsonView::number() const {
  if (!value_->is_number()) fail("expected a number: correct it");
  const double number = value_->get<double>();
  if (!std::isfinite(number)) fail("a number that fits no double: correct it");
  return number;
}

const std::string& JsonView::text() const {
  if (!value_->is_string()) fail("expected a text: correct it");
  return value_->get_ref<const std::string&>();
}

bool JsonView::flag(const char* key) const {
  const std::optional<JsonView> found = find(key);
  if (found && !found->value_->is_boolean()) found->fail("expected true or false: correct it");
  return found && found->value_->get<bool>();
}

void JsonView::fail(std::string_view message, std::uint64_t index) const {
  bad_file(*name_, where_.empty() ? std::string(message) : fmt::format("{}: {}", where_, message),
           index);
}

nlohmann::json parse_json(std::string_view bytes, const std::string& name) {
  try {
    return nlohmann::json::parse(bytes.begin(), bytes.end());
  } catch (const nlohmann::json::parse_error& error) {
    bad_byte(name, error.byte, "is no JSON from here on: it was cut off or damaged, get it again");
  } catch (const nlohmann::json::exception& error) {
    bad_file(name, fmt::format("is no JSON ({}): correct it", in_quotes(error.what(), 200)));
  }
}

}  // namespace pierce::io
