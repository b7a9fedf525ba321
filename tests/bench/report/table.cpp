#include "tests/bench/report/table.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <system_error>

#include "core/support/check.h"
#include "core/support/instruction_set.h"
#include "protocol/files/output_file.h"
#include "protocol/files/text.h"

namespace vat::bench {

namespace {

std::string markdown_text(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) {
    std::string escaped;
    for (const char c : *text) {
      if (c == '|') escaped += '\\';
      escaped += c;
    }
    return escaped;
  }
  if (const auto* value = std::get_if<Real>(&cell)) return short_text(*value);
  if (const auto* count = std::get_if<std::uint64_t>(&cell)) return std::to_string(*count);
  return std::get<bool>(cell) ? "yes" : "no";
}

void append_csv_cell(std::string& out, const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) {
    append_csv_field(out, *text);
  } else if (const auto* value = std::get_if<Real>(&cell)) {
    if (std::isfinite(*value)) append_number(out, *value);
  } else if (const auto* count = std::get_if<std::uint64_t>(&cell)) {
    append_number(out, *count);
  } else {
    out += std::get<bool>(cell) ? "true" : "false";
  }
}

}  // namespace

std::string short_text(Real value) {
  if (!std::isfinite(value)) return "-";
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

std::string hash_text(std::uint64_t hash) {
  std::string text;
  append_hash(text, hash);
  return text + ' ' + to_string(best_instruction_set());
}

std::string to_markdown(const Table& table) {
  std::string text = "|";
  for (const std::string& column : table.columns) text += ' ' + column + " |";
  text += "\n|";
  for (std::size_t i = 0; i < table.columns.size(); ++i) text += "---|";
  text += '\n';
  for (const std::vector<Cell>& row : table.rows) {
    VAT_CHECK(row.size() == table.columns.size());
    text += '|';
    for (const Cell& cell : row) text += ' ' + markdown_text(cell) + " |";
    text += '\n';
  }
  return text;
}

std::string to_csv(const Table& table) {
  std::string text;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (i > 0) text += ',';
    append_csv_field(text, table.columns[i]);
  }
  text += '\n';
  for (const std::vector<Cell>& row : table.rows) {
    VAT_CHECK(row.size() == table.columns.size());
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text += ',';
      append_csv_cell(text, row[i]);
    }
    text += '\n';
  }
  return text;
}

std::string to_json(const Table& table) {
  auto rows = nlohmann::ordered_json::array();
  for (const std::vector<Cell>& row : table.rows) {
    VAT_CHECK(row.size() == table.columns.size());
    nlohmann::ordered_json object;
    for (std::size_t i = 0; i < row.size(); ++i) {
      std::visit([&](const auto& value) { object[table.columns[i]] = value; }, row[i]);
    }
    rows.push_back(std::move(object));
  }
  return rows.dump(1) + '\n';
}

Status write_text(const std::filesystem::path& file, const std::string& text) {
  Result<OutputFile> created = OutputFile::create(file.string());
  if (!created) return created.errors();
  if (Status written = created.value().append(text); !written) return written;
  return created.value().commit();
}

Status write_table(const Table& table, const std::filesystem::path& folder, const std::string& name,
                   const std::string& heading) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return Error{"system", folder.string(), error.message()};
  const std::filesystem::path base = folder / name;
  if (Status done = write_text(base.string() + ".md", heading + "\n\n" + to_markdown(table));
      !done) {
    return done;
  }
  if (Status done = write_text(base.string() + ".csv", to_csv(table)); !done) return done;
  return write_text(base.string() + ".json", to_json(table));
}

}  // namespace vat::bench
