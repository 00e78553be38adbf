// SPDX-License-Identifier: Apache-2.0
//
// Tables in .csv files: numbers between commas, one row a line, perhaps a line of names first.
// Empty lines and lines that start with # are stepped over.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "io/bad_file.h"
#include "io/mapped_file.h"
#include "io/number_table.h"
#include "io/text_cursor.h"

namespace pierce::io {
namespace {

std::string_view trimmed(std::string_view text, std::string_view what) {
  const std::size_t first = text.find_first_not_of(what);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(what) - first + 1);
}

class CsvParser {
 public:
  CsvParser(std::string_view text, const std::string& name, const TableShape& shape,
            std::vector<double>& numbers)
      : text_(text), name_(name), shape_(shape), numbers_(numbers) {}

  std::size_t parse() {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
    bool first = true;
    while (!text_.empty()) {
      const std::size_t end = std::min(text_.find('\n'), text_.size());
      const std::string_view line = trimmed(text_.substr(0, end), " \t\r");
      text_.remove_prefix(std::min(end + 1, text_.size()));
      ++line_;
      if (line.empty() || line[0] == '#') continue;
      split(line);
      if (!first || !is_title()) add_row();
      first = false;
    }
    if (columns_ == 0) columns_ = shape_.fewest_columns;  // no row: any number is right
    return columns_;
  }

 private:
  void split(std::string_view line) {
    fields_.clear();
    while (true) {
      const std::size_t comma = line.find(',');
      fields_.push_back(trimmed(line.substr(0, comma), " \t"));
      if (comma == line.npos) return;
      line.remove_prefix(comma + 1);
    }
  }

  // A first line without any number names the columns. If these are our names in another order,
  // the numbers are in another order, too.
  [[nodiscard]] bool is_title() const {
    double ignored = 0;
    for (const std::string_view field : fields_) {
      if (parse_number(field, ignored)) return false;
    }
    bool in_order = true;
    std::size_t known = 0;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      const std::string_view title = trimmed(fields_[i], " \"'");
      for (std::size_t k = 0; k < shape_.columns.size(); ++k) {
        if (!same_word(title, shape_.columns[k])) continue;
        ++known;
        in_order = in_order && i == k;
      }
    }
    if (known == fields_.size() && !in_order) {
      bad_line(name_, line_,
               fmt::format("the columns are in another order than {}: reorder them",
                           fmt::join(shape_.columns, ",")));
    }
    return true;
  }

  void add_row() {
    const std::size_t most = shape_.columns.size();
    const std::size_t width = fields_.size();
    const bool fits =
        columns_ == 0 ? width == shape_.fewest_columns || width == most : width == columns_;
    if (!fits) {
      const std::string wanted = columns_ != 0
                                     ? fmt::format("{} numbers like the rows above", columns_)
                                 : most == shape_.fewest_columns
                                     ? fmt::format("{} numbers", most)
                                     : fmt::format("{} or {} numbers", shape_.fewest_columns, most);
      bad_line(name_, line_,
               fmt::format("{} need {} ({}) between commas, found {}: correct the line",
                           shape_.what, wanted, fmt::join(shape_.columns, ","), width));
    }
    columns_ = width;
    for (std::size_t i = 0; i < width; ++i) {
      double value = 0;
      if (!parse_number(fields_[i], value)) {
        bad_line(name_, line_,
                 fmt::format("column {}: {} is no number that fits a double: correct "
                             "it",
                             shape_.columns[i], in_quotes(fields_[i])));
      }
      numbers_.push_back(value);
    }
  }

  std::string_view text_;
  const std::string& name_;
  const TableShape& shape_;
  std::vector<double>& numbers_;
  std::vector<std::string_view> fields_;
  std::uint64_t line_ = 0;
  std::size_t columns_ = 0;  // 0: no row yet
};

class CsvTable : public NumberTable {
 public:
  CsvTable(const std::filesystem::path& path, const TableShape& shape)
      : NumberTable(path.string()) {
    const MappedFile file(path);
    if (file.bytes().substr(0, 1024).find('\0') != std::string_view::npos) {
      bad_file(name_,
               fmt::format("is neither .npy nor .csv: save the {} as one of these", shape.what));
    }
    columns_ = parse_csv(file.bytes(), name_, shape, numbers_);
    rows_ = numbers_.size() / columns_;
  }

  void read(std::uint64_t first, std::span<double> out) const override {
    std::copy_n(numbers_.begin() + static_cast<std::ptrdiff_t>(first * columns_), out.size(),
                out.begin());
  }

 private:
  std::vector<double> numbers_;
};

}  // namespace

std::size_t parse_csv(std::string_view text, const std::string& name, const TableShape& shape,
                      std::vector<double>& numbers) {
  return CsvParser(text, name, shape, numbers).parse();
}

std::unique_ptr<NumberTable> open_csv_table(const std::filesystem::path& path,
                                            const TableShape& shape) {
  return std::make_unique<CsvTable>(path, shape);
}

}  // namespace pierce::io
