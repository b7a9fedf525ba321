#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"

namespace vat::bench {

/// A CSV file (RFC 4180) with a header row, as text. Every row is as long as the header.
struct CsvFile {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

/// Reads a CSV file. Fails if it cannot be read, is empty, has an unclosed quote or rows of
/// different lengths.
Result<CsvFile> read_csv_file(const std::filesystem::path& file);
/// Parses a text in the same way.
Result<CsvFile> parse_csv(std::string_view text);

}  // namespace vat::bench
