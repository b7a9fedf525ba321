#include "tests/bench/document/page_tables.h"

#include <algorithm>
#include <cstdio>
#include <vector>

namespace vat::bench {

namespace {

std::string text(const Json& row, const char* column) {
  return row.at(column).get<std::string>();
}

/// With three digits; a dash where the value is absent.
std::string number(const Json& row, const char* column) {
  const Json& value = row.at(column);
  if (value.is_null()) return "–";
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g", value.get<Real>());
  return buffer;
}

bool is_judged(const Json& row) {
  return !row.at("passed").is_null();
}

Real share(const Json& row) {
  const Json& value = row.at("share of tolerance");
  return value.is_null() ? 0 : value.get<Real>();
}

/// Consecutive rows with the same case.
std::vector<std::vector<Json>> by_case(const Json& rows) {
  std::vector<std::vector<Json>> groups;
  for (const Json& row : rows) {
    if (groups.empty() || groups.back().front().at("case") != row.at("case")) groups.emplace_back();
    groups.back().push_back(row);
  }
  return groups;
}

std::string method_cell(const Json& row) {
  const std::string method = text(row, "fewest evaluations");
  if (row.at("evaluations per particle").is_null()) return "–";
  return method + ": " + number(row, "evaluations per particle");
}

std::string law_cell(const Json& row) {
  if (row.at("seconds").is_null()) return "–";
  char milliseconds[32];
  std::snprintf(milliseconds, sizeof milliseconds, "%.2g", 1e3 * row.at("seconds").get<Real>());
  return text(row, "least time") + ": " + milliseconds + " ms";
}

}  // namespace

Table cases_table(const Json& validation, const std::map<std::string, std::string>& titles) {
  Table table{
      {"case", "what", "metrics", "the one nearest to its tolerance", "measured", "must be"}, {}};
  for (const std::vector<Json>& rows : by_case(validation)) {
    const Json& main = *std::ranges::max_element(rows, [](const Json& a, const Json& b) {
      return std::pair(is_judged(a), share(a)) < std::pair(is_judged(b), share(b));
    });
    const std::string name = text(main, "case");
    table.rows.push_back({name, titles.at(name), std::uint64_t{rows.size()}, text(main, "metric"),
                          main.at("measured").get<Real>(), text(main, "must be")});
  }
  return table;
}

Table limits_table(const Json& validation) {
  Table table{{"case", "metric", "measured", "exact, or published", "why"}, {}};
  for (const Json& row : validation) {
    if (is_judged(row)) continue;
    table.rows.push_back({text(row, "case"), text(row, "metric"), number(row, "measured"),
                          number(row, "reference"), text(row, "tolerance from")});
  }
  return table;
}

Table methods_table(const Json& cheapest) {
  Table table{{"problem"}, {}};
  for (const std::vector<Json>& rows : by_case(cheapest)) {
    std::vector<Cell> cells = {text(rows.front(), "case")};
    for (const Json& row : rows) {
      if (table.rows.empty()) table.columns.push_back("error " + number(row, "error at most"));
      cells.emplace_back(method_cell(row));
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Table steps_table(const Json& control) {
  Table table{{"problem", "error", "best fixed", "evaluations", "best adaptive", "its evaluations",
               "time", "local: evaluations", "time"},
              {}};
  for (const Json& row : control) {
    if (row.at("its evaluations per particle").is_null()) continue;
    table.rows.push_back({text(row, "case"), number(row, "error at most"), text(row, "best fixed"),
                          number(row, "its evaluations per particle"), text(row, "best adaptive"),
                          number(row, "evaluations / fixed"), number(row, "time / fixed"),
                          number(row, "local: evaluations / fixed"),
                          number(row, "local: time / fixed")});
  }
  return table;
}

Table laws_table(const Json& laws) {
  Table table{{"problem", "law"}, {}};
  const auto is_of = [](const std::vector<Cell>& cells, const Json& row) {
    return std::get<std::string>(cells[0]) == text(row, "problem") &&
           std::get<std::string>(cells[1]) == text(row, "law");
  };
  for (const Json& row : laws) {
    if (table.rows.empty() || !is_of(table.rows.back(), row)) {
      table.rows.push_back({text(row, "problem"), text(row, "law")});
    }
    if (table.rows.size() == 1) table.columns.push_back("error " + number(row, "error at most"));
    table.rows.back().emplace_back(law_cell(row));
  }
  return table;
}

Table solvers_table(const Json& solvers) {
  Table table{{"problem", "solver", "layers", "error of", "error", "mean density error",
               "greatest density error", "steps"},
              {}};
  for (const Json& row : solvers) {
    table.rows.push_back({text(row, "problem"), text(row, "solver"),
                          row.at("layers").get<std::uint64_t>(), text(row, "error of"),
                          row.at("error").get<Real>(), row.at("mean density error").get<Real>(),
                          row.at("greatest density error").get<Real>(),
                          row.at("steps").get<std::uint64_t>()});
  }
  return table;
}

Table counts_table(const Json& stability) {
  Table table{{"part", "scenes", "not finite", "aborts", "outside", "guard events", "retries",
               "wall stops", "stopped", "refused", "faults"},
              {}};
  for (const Json& row : stability) {
    std::vector<Cell> cells = {text(row, "part")};
    for (auto column = table.columns.begin() + 1; column != table.columns.end(); ++column) {
      cells.emplace_back(row.at(*column).get<std::uint64_t>());
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

}  // namespace vat::bench
