#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "core/support/result.h"
#include "core/types.h"

namespace vat::bench {

/// A table cell. Counts are whole numbers. A non-finite Real is an absent value.
using Cell = std::variant<std::string, Real, std::uint64_t, bool>;

/// The absent value of a Real cell.
inline constexpr Real kAbsent = std::numeric_limits<Real>::quiet_NaN();

/// Results as rows with one cell per column.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;
};

/// Returns a table for readers: six digits, yes and no, "-" for absent values.
std::string to_markdown(const Table& table);
/// Returns CSV (RFC 4180): all digits, true and false, empty for absent values.
std::string to_csv(const Table& table);
/// Returns an array of objects with the columns as keys; null for absent values.
std::string to_json(const Table& table);

/// Returns the state hash with the machine's best instruction set, which all runs use.
std::string hash_text(std::uint64_t hash);
/// Formats a number with six digits, or "-" if it is not finite.
std::string short_text(Real value);

/// Writes FOLDER/NAME.md, .csv and .json, and creates the folder. The Markdown file starts with
/// `heading`.
Status write_table(const Table& table, const std::filesystem::path& folder, const std::string& name,
                   const std::string& heading);

/// Replaces the content of the file.
Status write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace vat::bench
