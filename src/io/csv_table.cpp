// SPDX-License-Identifier: Apache-2.0
//
// Tables in text: numbers between commas, semicolons, tabs or blanks, one row a line, perhaps a
// line of titles first. Empty lines and lines that start with # or % are stepped over, but for
// titles in such a line: who writes them means them.
//
// The first line decides what stands between fields: that which makes a row or titles of it. A line
// that is neither is refused: a table is never taken for an empty one.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <numeric>
#include <optional>

#include "io/bad_file.h"
#include "io/csv_fields.h"
#include "io/extension.h"
#include "io/number_table.h"
#include "io/packed.h"
#include "io/text_cursor.h"
#include "io/text_encoding.h"
#include "support/count_words.h"

namespace pierce::io {
namespace {

constexpr std::string_view kComments = "#%";
constexpr std::array<char, 4> kSeparators = {',', ';', '\t', ' '};

const char* name_of(char separator) {
  switch (separator) {
    case ',':
      return "commas";
    case ';':
      return "semicolons";
    case '\t':
      return "tabs";
    default:
      return "blanks";
  }
}

class CsvParser {
 public:
  CsvParser(std::string_view text, const std::string& name, const TableShape& shape)
      : text_(text), name_(name), shape_(shape) {}

  TableNumbers parse() {
    const std::string_view all = without_mark(text_);
    text_ = without_padding(all);
    if (text_.size() != all.size()) {
      table_.remarks.push_back(
          fmt::format("{}: {} behind the end of the text left out", name_,
                      counted(all.size() - text_.size(), "empty byte", "empty bytes")));
    }
    bool first = true;
    while (!text_.empty()) {
      std::string_view line = trimmed(take_line(text_), " \t");
      ++line_;
      if (line.empty() || (first && is_separator_line(line))) continue;
      if (kComments.find(line[0]) != kComments.npos) {
        if (first) note_comment(line.substr(1));
        continue;
      }
      if (rows_ == 0 && is_count(line)) continue;
      if (first) {
        read_first(line);
      } else {
        split(line);
        add_row();
      }
      first = false;
    }
    if (first) number_columns(shape_.fewest);  // no row: any number is right
    if (count_line_ != 0 && static_cast<std::uint64_t>(count_) != rows_) {
      bad_line(
          name_, count_line_,
          fmt::format("{} are announced, {} {} there: the file was cut off; or remove this line",
                      counted(static_cast<std::uint64_t>(count_), "row", "rows"), rows_,
                      rows_ == 1 ? "is" : "are"));
    }
    if (counts_up_ && rows_ > 1 && all_decimal_) {
      bad_line(name_, first_line_,
               fmt::format("the first line, 0,1,...,{}, looks like titles, for all other numbers "
                           "have a decimal {}: name the columns, or write 0.0 if it is a row",
                           columns_.size() - 1, decimal_ == ',' ? "comma" : "point"));
    }
    if (counts_up_) {
      table_.remarks.push_back(
          fmt::format("{}: the first line, 0,1,...,{}, is read as numbers; if "
                      "these are titles, name the columns",
                      name_, columns_.size() - 1));
    }
    if (table_.numbers.empty()) {
      table_.remarks.push_back(fmt::format("{}: holds no {}", name_, shape_.what));
    }
    if (decimal_ == ',') {
      table_.remarks.push_back(fmt::format("{}: commas are read as decimal signs", name_));
    }
    return std::move(table_);
  }

 private:
  // "sep=;", which spreadsheets write and hide.
  [[nodiscard]] static bool is_separator_line(std::string_view line) {
    return line.size() == 5 && same_word(line.substr(0, 4), "sep=");
  }

  // How many rows follow, as .pts files have it; some programs write it below the titles.
  [[nodiscard]] bool is_count(std::string_view line) {
    if (shape_.fewest == 1 || count_line_ != 0) return false;
    if (!parse_integer(line, count_) || count_ < 0) return false;
    count_line_ = line_;
    return true;
  }

  // A comment before the first row that names all columns, for as many fields as the row has.
  void note_comment(std::string_view text) {
    for (const char separator : kSeparators) {
      separator_ = separator;
      split(trimmed(text, " \t"));
      if (!are_good_titles()) continue;
      commented_ = titles();
      return;
    }
  }

  void split(std::string_view line) {
    split_fields(line, separator_, fields_);
    // Some programs write a separator behind the last field, too.
    const bool one_more = !titled_ || fields_.size() == columns_.size() + 1;
    if (one_more && fields_.size() > 1 && fields_.back().empty()) fields_.pop_back();
  }

  void read_first(std::string_view line) {
    constexpr std::string_view kTitleMark = "//";  // of CloudCompare
    const std::string_view titles =
        line.starts_with(kTitleMark) ? line.substr(kTitleMark.size()) : line;
    for (const char separator : kSeparators) {
      separator_ = separator;
      split(titles);
      if (are_good_titles()) return read_titles(this->titles());
      split(line);
      if (fits_comment()) {
        read_titles(commented_);
        return add_row();
      }
      if (is_row()) return read_first_row();
      if (is_cloud_row()) return read_first_cloud_row();
    }
    // Nothing fits: told as what it looks like most.
    separator_ = ' ';
    for (const char separator : {';', ',', '\t'}) {
      if (line.find(separator) == line.npos) continue;
      separator_ = separator;
      break;
    }
    split(titles);
    if (without_numbers() && fields_.size() > 1) return read_titles(this->titles());
    split(line);
    read_first_row();
  }

  [[nodiscard]] bool is_row() const {
    FieldNumber number;
    return (fields_.size() == shape_.fewest || fields_.size() == shape_.columns.size()) &&
           std::all_of(fields_.begin(), fields_.end(), [&](std::string_view field) {
             return parse_field(field, separator_, number);
           });
  }

  [[nodiscard]] bool fits_comment() const {
    return fields_.size() == commented_.size() && fields_.size() > 1 && !without_numbers();
  }

  [[nodiscard]] bool is_cloud_row() const {
    constexpr std::array<const char*, 5> kClouds = {".xyz", ".xyzn", ".xyzrgb", ".pts", ".asc"};
    const std::filesystem::path path = unpacked_name(name_);
    FieldNumber number;
    return shape_.point_cloud && fields_.size() > shape_.fewest &&
           std::any_of(kClouds.begin(), kClouds.end(),
                       [&](const char* cloud) { return has_extension(path, cloud); }) &&
           std::all_of(fields_.begin(), fields_.end(), [&](std::string_view field) {
             return parse_field(field, separator_, number);
           });
  }

  void read_first_cloud_row() {
    const std::size_t width = fields_.size();
    number_columns(shape_.fewest);
    columns_.resize(width, kNoColumn);
    table_.remarks.push_back(
        fmt::format("{}: {} not used", name_,
                    counted(width - shape_.fewest, "more column is", "more columns are")));
    add_row();
  }

  [[nodiscard]] bool without_numbers() const {
    FieldNumber number;
    return std::none_of(fields_.begin(), fields_.end(), [&](std::string_view field) {
      return parse_field(field, separator_, number);
    });
  }

  // Numbers may be the titles of columns that are not used.
  [[nodiscard]] bool are_good_titles() const {
    return fields_.size() > 1 && match_columns(titles(), shape_).trouble.empty();
  }

  // Without quotes, and without the unit: "x [m]" and "x (m)" are x.
  [[nodiscard]] std::vector<ColumnTitle> titles() const {
    std::vector<ColumnTitle> titles;
    for (const std::string_view field : fields_) {
      std::string_view title = trimmed(field, " \"'");
      const std::size_t unit = title.find_first_of("[(");
      if (unit != title.npos && unit > 0) title = trimmed(title.substr(0, unit), " ");
      titles.push_back({std::string(title)});
    }
    return titles;
  }

  void read_titles(const std::vector<ColumnTitle>& titles) {
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
  void read_first_row() {
    const std::size_t width = fields_.size();
    if (width != shape_.fewest && width != shape_.columns.size()) {
      const std::string_view few = decimal_cure(shape_.fewest);
      const std::string_view cure = few.empty() ? decimal_cure(shape_.columns.size()) : few;
      bad_line(name_, line_,
               fmt::format("{} need {} numbers ({}) between commas, found {}: correct the line, or "
                           "name the columns in a first line{}",
                           shape_.what, column_counts(shape_), column_names(shape_), width, cure));
    }
    number_columns(width);
    counts_up_ = counts_up();
    first_line_ = line_;
    add_row();
  }

  // What else to do if each number came in two pieces.
  [[nodiscard]] std::string_view decimal_cure(std::size_t expected) const {
    const bool halves = separator_ == ',' && fields_.size() == 2 * expected;
    return halves ? "; if commas are decimal signs, put semicolons between the numbers" : "";
  }

  void number_columns(std::size_t count) {
    columns_.resize(count);
    std::iota(columns_.begin(), columns_.end(), std::size_t{0});
    table_.columns = columns_;
  }

  // As some programs title columns without names.
  [[nodiscard]] bool counts_up() const {
    FieldNumber number;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (!parse_field(fields_[i], separator_, number)) return false;
      if (number.value != static_cast<double>(i) || number.decimal != '\0') return false;
    }
    return true;
  }

  void add_row() {
    if (fields_.size() != columns_.size()) {
      bad_line(
          name_, line_,
          fmt::format("expected {} fields like the {} above, found {}{}: correct the line",
                      columns_.size(), titled_ ? "titles" : "rows", fields_.size(),
                      separator_ == ',' ? "" : fmt::format(" between {}", name_of(separator_))));
    }
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (columns_[i] == kNoColumn) continue;
      FieldNumber number;
      if (!parse_field(fields_[i], separator_, number)) {
        bad_line(name_, line_,
                 fmt::format("column {}: {} is no number that fits a double: {}",
                             shape_.columns[columns_[i]].name, in_quotes(fields_[i]),
                             number_cure(fields_[i])));
      }
      if (number.decimal != '\0') check_decimal(number.decimal, fields_[i]);
      all_decimal_ = all_decimal_ && (rows_ == 0 || number.decimal != '\0');
      table_.numbers.push_back(number.value);
    }
    ++rows_;
  }

  // 1,234 is another number in a file with decimal points.
  void check_decimal(char decimal, std::string_view field) {
    if (decimal_ == '\0') decimal_ = decimal;
    if (decimal == decimal_) return;
    bad_line(name_, line_,
             fmt::format("{} has a decimal {}, numbers above have {}: write all with points",
                         in_quotes(field), decimal == ',' ? "comma" : "point",
                         decimal == ',' ? "points" : "commas"));
  }

  std::string_view text_;
  const std::string& name_;
  const TableShape& shape_;
  TableNumbers table_;
  std::vector<std::string_view> fields_;
  std::vector<std::size_t> columns_;    // of each field
  std::vector<ColumnTitle> commented_;  // of the last comment before the first row that is titles
  std::int64_t count_ = 0;              // announced
  std::uint64_t line_ = 0, first_line_ = 0, count_line_ = 0, rows_ = 0;
  char separator_ = ',', decimal_ = '\0';
  bool titled_ = false;
  bool counts_up_ = false;   // the first line, which is no titles
  bool all_decimal_ = true;  // all numbers but its
};

// Binary data, PCD, Parquet, JSON, a page: what no table begins with.
bool is_stranger(std::string_view text) {
  const std::string_view start = without_padding(text).substr(0, 1024);
  return start.find('\0') != start.npos || start.starts_with("# .PCD") ||
         start.starts_with("PAR1") || start.starts_with('{') || start.starts_with('<') ||
         start.starts_with("[[");
}

}  // namespace

TableNumbers parse_csv(std::string_view text, const std::string& name, const TableShape& shape) {
  const std::optional<std::string> decoded = from_utf16(text);
  if (decoded) text = *decoded;
  if (is_stranger(text)) {
    bad_file(name,
             fmt::format("is neither .npy nor .csv: save the {} as one of these", shape.what));
  }
  return CsvParser(text, name, shape).parse();
}

std::unique_ptr<NumberTable> open_csv_table(InputFile file, const TableShape& shape) {
  return make_table(parse_csv(file.bytes(), file.name(), shape), file.name(), shape);
}

}  // namespace pierce::io
