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

/// Counts are whole numbers; a Real that is not finite is an absent value.
using Cell = std::variant<std::string, Real, std::uint64_t, bool>;

/// An absent value of a Real cell.
inline constexpr Real kAbsent = std::numeric_limits<Real>::quiet_NaN();

/// Results as rows of one cell a column.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;
};

/// A table for readers: real numbers with six digits, yes and no, "-" for absent values.
std::string to_markdown(const Table& table);
/// RFC 4180: real numbers with all their digits, true and false, nothing for absent values.
std::string to_csv(const Table& table);
/// An array of objects with the columns as keys; null for absent values.
std::string to_json(const Table& table);

/// The state hash and the instruction set: the machine's best, as of all runs here.
std::string hash_text(std::uint64_t hash);
/// A real number with six digits, "-" where it is not finite.
std::string short_text(Real value);

/// Writes FOLDER/NAME.md, .csv and .json, and makes the folder. Markdown begins with `heading`.
Status write_table(const Table& table, const std::filesystem::path& folder, const std::string& name,
                   const std::string& heading);

/// Replaces the file's content.
Status write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace vat::bench
