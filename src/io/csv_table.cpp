// SPDX-License-Identifier: Apache-2.0
//
// Tables in .csv files: numbers between commas, one row a line, perhaps a line of titles first.
// Empty lines and lines that start with # are stepped over.
//
// A first line without any number is titles, and must name the columns; any other is a row.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "io/bad_file.h"
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
  CsvParser(std::string_view text, const std::string& name, const TableShape& shape)
      : text_(text), name_(name), shape_(shape) {}

  TableNumbers parse() {
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
      if (first && are_titles()) {
        read_titles();
      } else {
        if (first) count_columns();
        add_row();
      }
      first = false;
    }
    if (first) number_columns(shape_.fewest);  // no row: any number is right
    return std::move(table_);
  }

 private:
  // At the commas that are in no quotes.
  void split(std::string_view line) {
    fields_.clear();
    if (line.find('"') == line.npos) {
      for (std::size_t comma = line.find(','); comma != line.npos; comma = line.find(',')) {
        fields_.push_back(trimmed(line.substr(0, comma), " \t"));
        line.remove_prefix(comma + 1);
      }
      fields_.push_back(trimmed(line, " \t"));
      return;
    }
    bool quoted = false;
    std::size_t start = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '"') quoted = !quoted;
      if (line[i] != ',' || quoted) continue;
      fields_.push_back(trimmed(line.substr(start, i - start), " \t"));
      start = i + 1;
    }
    fields_.push_back(trimmed(line.substr(start), " \t"));
  }

  [[nodiscard]] bool are_titles() const {
    double ignored = 0;  // a line without a comma is neither, and short of numbers
    return fields_.size() > 1 &&
           std::none_of(fields_.begin(), fields_.end(),
                        [&](std::string_view field) { return parse_number(field, ignored); });
  }

  void read_titles() {
    std::vector<ColumnTitle> titles;
    for (const std::string_view field : fields_) {
      titles.push_back({std::string(trimmed(field, " \"'"))});
    }
    const ColumnMatch match = match_columns(titles, shape_);
    if (!match.trouble.empty()) {
      bad_line(name_, line_, fmt::format("the titles: {}", match.trouble));
    }
    if (!match.unused.empty()) {
      table_.remarks.push_back(
          fmt::format("{}: columns that are not used: {}", name_, match.unused));
    }
    columns_ = match.columns;
    for (const std::size_t column : columns_) {
      if (column != kNoColumn) table_.columns.push_back(column);
    }
    titled_ = true;
  }

  // The first line is a row, and there are no titles.
  void count_columns() {
    const std::size_t width = fields_.size();
    if (width != shape_.fewest && width != shape_.columns.size()) {
      bad_line(name_, line_,
               fmt::format("{} need {} numbers ({}) between commas, found {}: correct the line, or "
                           "name the columns in a first line",
                           shape_.what, column_counts(shape_), column_names(shape_), width));
    }
    number_columns(width);
    if (counts_up()) {
      table_.remarks.push_back(
          fmt::format("{}: the first line, 0,1,...,{}, is read as numbers; if "
                      "these are titles, name the columns",
                      name_, width - 1));
    }
  }

  void number_columns(std::size_t count) {
    columns_.resize(count);
    std::iota(columns_.begin(), columns_.end(), std::size_t{0});
    table_.columns = columns_;
  }

  // As some programs title columns without names.
  [[nodiscard]] bool counts_up() const {
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (fields_[i] != fmt::format("{}", i)) return false;
    }
    return true;
  }

  void add_row() {
    if (fields_.size() != columns_.size()) {
      bad_line(name_, line_,
               fmt::format("expected {} fields like the {} above, found {}: correct the line",
                           columns_.size(), titled_ ? "titles" : "rows", fields_.size()));
    }
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (columns_[i] == kNoColumn) continue;
      double value = 0;
      if (!parse_number(fields_[i], value)) {
        bad_line(name_, line_,
                 fmt::format("column {}: {} is no number that fits a double: correct it",
                             shape_.columns[columns_[i]].name, in_quotes(fields_[i])));
      }
      table_.numbers.push_back(value);
    }
  }

  std::string_view text_;
  const std::string& name_;
  const TableShape& shape_;
  TableNumbers table_;
  std::vector<std::string_view> fields_;
  std::vector<std::size_t> columns_;  // of each field
  std::uint64_t line_ = 0;
  bool titled_ = false;
};

}  // namespace

TableNumbers parse_csv(std::string_view text, const std::string& name, const TableShape& shape) {
  return CsvParser(text, name, shape).parse();
}

std::unique_ptr<NumberTable> open_csv_table(InputFile file, const TableShape& shape) {
  const std::string_view text = file.bytes();
  if (text.substr(0, 1024).find('\0') != std::string_view::npos) {
    bad_file(file.name(),
             fmt::format("is neither .npy nor .csv: save the {} as one of these", shape.what));
  }
  return make_table(parse_csv(text, file.name(), shape), file.name(), shape);
}

}  // namespace pierce::io
