#include "tests/bench/report/csv_file.h"

#include <fstream>
#include <sstream>
#include <utility>

namespace vat::bench {

namespace {

/// Parses cells and rows from the start of a text.
class CsvParser {
 public:
  explicit CsvParser(std::string_view text) : rest_(text) {}

  bool at_end() const { return rest_.empty(); }

  /// Returns the next row. Fails if a quote is not closed, or text follows its end.
  Result<std::vector<std::string>> take_row() {
    std::vector<std::string> row;
    do {
      Result<std::string> cell = rest_.starts_with('"') ? take_quoted() : take_plain();
      if (!cell) return cell.errors();
      row.push_back(std::move(cell).value());
    } while (skip(","));
    if (!skip("\r\n") && !skip("\n") && !at_end()) {
      return Error{"malformed", "", "text follows a closing quote"};
    }
    return row;
  }

 private:
  bool skip(std::string_view what) {
    if (!rest_.starts_with(what)) return false;
    rest_.remove_prefix(what.size());
    return true;
  }

  Result<std::string> take_plain() {
    std::string cell(rest_.substr(0, rest_.find_first_of(",\n")));
    rest_.remove_prefix(cell.size());
    if (cell.ends_with('\r')) cell.pop_back();
    return cell;
  }

  Result<std::string> take_quoted() {
    std::string cell;
    skip("\"");
    for (;;) {
      const std::size_t quote = rest_.find('"');
      if (quote == std::string_view::npos) {
        return Error{"malformed", "", "a quote is not closed"};
      }
      cell += rest_.substr(0, quote);
      rest_.remove_prefix(quote + 1);
      if (!skip("\"")) return cell;
      cell += '"';
    }
  }

  std::string_view rest_;
};

}  // namespace

Result<CsvFile> parse_csv(std::string_view text) {
  CsvParser parser(text);
  if (parser.at_end()) return Error{"malformed", "", "is empty"};
  CsvFile file;
  for (std::size_t number = 1; !parser.at_end(); ++number) {
    Result<std::vector<std::string>> row = parser.take_row();
    const std::string where = "row " + std::to_string(number) + ": ";
    if (!row) return Error{"malformed", "", where + row.errors().front().message};
    if (number == 1) {
      file.columns = std::move(row).value();
      continue;
    }
    if (row.value().size() != file.columns.size()) {
      return Error{"malformed", "",
                   where + "has " + std::to_string(row.value().size()) + " cells and the header " +
                       std::to_string(file.columns.size())};
    }
    file.rows.push_back(std::move(row).value());
  }
  return file;
}

Result<CsvFile> read_csv_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::error_code error_code;
  if (!stream || std::filesystem::is_directory(file, error_code)) {
    return Error{"system", file.string(), "cannot be read"};
  }
  std::ostringstream text;
  text << stream.rdbuf();
  if (stream.bad()) return Error{"system", file.string(), "cannot be read to its end"};
  Result<CsvFile> parsed = parse_csv(text.str());
  if (parsed) return parsed;
  Error error = parsed.errors().front();
  error.path = file.string();
  return error;
}

}  // namespace vat::bench
