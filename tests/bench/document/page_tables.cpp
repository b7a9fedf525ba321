#include "tests/bench/document/page_tables.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <string_view>
#include <vector>

namespace vat::bench {

namespace {

std::string cell_text(const Json& row, const char* column) {
  return row.at(column).get<std::string>();
}

std::string three_digits(Real value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.3g", value);
  return buffer;
}

std::string three_digits_or_whole(Real value) {
  return value < 1000 ? three_digits(value) : std::to_string(std::lround(value));
}

/// Formats a value with three digits, or as a dash if it is absent.
std::string cell_number(const Json& row, const char* column) {
  const Json& value = row.at(column);
  return value.is_null() ? "–" : three_digits(value.get<Real>());
}

bool is_judged(const Json& row) {
  return !row.at("passed").is_null();
}

Real share(const Json& row) {
  const Json& value = row.at("share of tolerance");
  return value.is_null() ? 0 : value.get<Real>();
}

/// Returns groups of consecutive rows with the same case.
std::vector<std::vector<Json>> by_case(const Json& rows) {
  std::vector<std::vector<Json>> groups;
  for (const Json& row : rows) {
    if (groups.empty() || groups.back().front().at("case") != row.at("case")) groups.emplace_back();
    groups.back().push_back(row);
  }
  return groups;
}

std::string method_cell(const Json& row) {
  const std::string method = cell_text(row, "fewest evaluations");
  if (row.at("evaluations per particle").is_null()) return "–";
  return method + ": " + cell_number(row, "evaluations per particle");
}

std::string machine_cell(const Json& row) {
  return cell_text(row, "cpu") + ", " + std::to_string(row.at("cores").get<std::uint64_t>()) +
         " cores";
}

std::string law_cell(const Json& row) {
  if (row.at("seconds").is_null()) return "–";
  char milliseconds[32];
  std::snprintf(milliseconds, sizeof milliseconds, "%.2g", 1e3 * row.at("seconds").get<Real>());
  return cell_text(row, "least time") + ": " + milliseconds + " ms";
}

}  // namespace

Table cases_table(const Json& validation, const std::map<std::string, std::string>& titles) {
  Table table{{"case", "subject", "metrics", "metric closest to its tolerance", "measured",
               "reference and tolerance"},
              {}};
  for (const std::vector<Json>& rows : by_case(validation)) {
    const Json& main = *std::ranges::max_element(rows, [](const Json& a, const Json& b) {
      return std::pair(is_judged(a), share(a)) < std::pair(is_judged(b), share(b));
    });
    const std::string name = cell_text(main, "case");
    table.rows.push_back({name, titles.at(name), std::uint64_t{rows.size()},
                          cell_text(main, "metric"), main.at("measured").get<Real>(),
                          cell_text(main, "must be")});
  }
  return table;
}

Table summary_table(const Json& validation, const std::map<std::string, std::string>& titles) {
  constexpr std::string_view kCases[] = {"DEF-1",   "RIG-1",       "RIG-7",      "LIQ-3-tait",
                                         "LIQ-15i", "LIQ-12-tait", "INT-1-tait", "INT-5-tait"};
  Table table{{"case", "quantity", "measured", "reference and tolerance"}, {}};
  for (std::vector<Cell>& cells : cases_table(validation, titles).rows) {
    if (std::ranges::find(kCases, std::get<std::string>(cells[0])) == std::end(kCases)) continue;
    table.rows.push_back({std::move(cells[1]), std::move(cells[3]), cells[4], std::move(cells[5])});
  }
  return table;
}

Table limits_table(const Json& validation) {
  Table table{{"case", "metric", "measured", "reference", "cause"}, {}};
  for (const Json& row : validation) {
    if (is_judged(row)) continue;
    table.rows.push_back({cell_text(row, "case"), cell_text(row, "metric"),
                          cell_number(row, "measured"), cell_number(row, "reference"),
                          cell_text(row, "tolerance from")});
  }
  return table;
}

Table methods_table(const Json& cheapest) {
  Table table{{"problem"}, {}};
  for (const std::vector<Json>& rows : by_case(cheapest)) {
    std::vector<Cell> cells = {cell_text(rows.front(), "case")};
    for (const Json& row : rows) {
      if (table.rows.empty()) table.columns.push_back("error " + cell_number(row, "error at most"));
      cells.emplace_back(method_cell(row));
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Table steps_table(const Json& control) {
  Table table{{"problem", "error", "best fixed", "evaluations", "best adaptive",
               "adaptive: evaluations / fixed", "time / fixed", "local: evaluations / fixed",
               "time / fixed"},
              {}};
  for (const Json& row : control) {
    if (row.at("its evaluations per particle").is_null()) continue;
    table.rows.push_back(
        {cell_text(row, "case"), cell_number(row, "error at most"), cell_text(row, "best fixed"),
         cell_number(row, "its evaluations per particle"), cell_text(row, "best adaptive"),
         cell_number(row, "evaluations / fixed"), cell_number(row, "time / fixed"),
         cell_number(row, "local: evaluations / fixed"), cell_number(row, "local: time / fixed")});
  }
  return table;
}

Table laws_table(const Json& laws) {
  Table table{{"problem", "law"}, {}};
  const auto is_of = [](const std::vector<Cell>& cells, const Json& row) {
    return std::get<std::string>(cells[0]) == cell_text(row, "problem") &&
           std::get<std::string>(cells[1]) == cell_text(row, "law");
  };
  for (const Json& row : laws) {
    if (table.rows.empty() || !is_of(table.rows.back(), row)) {
      table.rows.push_back({cell_text(row, "problem"), cell_text(row, "law")});
    }
    if (table.rows.size() == 1)
      table.columns.push_back("error " + cell_number(row, "error at most"));
    table.rows.back().emplace_back(law_cell(row));
  }
  return table;
}

Table solvers_table(const Json& solvers) {
  Table table{{"problem", "solver", "layers", "error of", "error", "mean density error",
               "greatest density error", "steps"},
              {}};
  for (const Json& row : solvers) {
    table.rows.push_back({cell_text(row, "problem"), cell_text(row, "solver"),
                          row.at("layers").get<std::uint64_t>(), cell_text(row, "error of"),
                          row.at("error").get<Real>(), row.at("mean density error").get<Real>(),
                          row.at("greatest density error").get<Real>(),
                          row.at("steps").get<std::uint64_t>()});
  }
  return table;
}

Table tolerances_table(const Json& tolerances) {
  Table table{{"scene", "tolerance", "density error", "steps", "iterations for velocities",
               "iterations for positions"},
              {}};
  for (const Json& row : tolerances) {
    table.rows.push_back({cell_text(row, "scene"), row.at("tolerance").get<Real>(),
                          row.at("density error").get<Real>(), row.at("steps").get<std::uint64_t>(),
                          row.at("iterations for velocities").get<Real>(),
                          row.at("iterations for positions").get<Real>()});
  }
  return table;
}

Table accuracies_rows_table(const Json& accuracies) {
  Table table{{"scene", "accuracy", "error", "steps", "evaluations", "iterations"}, {}};
  for (const Json& row : accuracies) {
    table.rows.push_back({cell_text(row, "scene"), row.at("accuracy").get<Real>(),
                          row.at("error").get<Real>(), row.at("steps").get<std::uint64_t>(),
                          row.at("evaluations").get<std::uint64_t>(),
                          row.at("iterations").get<std::uint64_t>()});
  }
  return table;
}

Table growth_rows_table(const Json& growth) {
  Table table{{"solve", "size", "value", "iterations per step"}, {}};
  for (const Json& row : growth) {
    table.rows.push_back({cell_text(row, "solve"), cell_text(row, "size"),
                          row.at("value").get<std::uint64_t>(),
                          row.at("iterations per step").get<Real>()});
  }
  return table;
}

Table catalogue_rows_table(const Json& catalogue) {
  Table table{{"scene", "pressure solver", "particles", "step [ms]", "error at 0.3 s",
               "error at 1 s", "times real time"},
              {}};
  for (const Json& row : catalogue) {
    table.rows.push_back({cell_text(row, "scene"), cell_text(row, "pressure solver"),
                          row.at("particles").get<std::uint64_t>(), row.at("step [ms]").get<Real>(),
                          row.at("error at 0.3 s").get<Real>(), row.at("error later").get<Real>(),
                          row.at("times real time").get<Real>()});
  }
  return table;
}

Table counts_table(const Json& stability) {
  Table table{{"part", "scenes", "not finite", "aborts", "outside", "guard events", "retries",
               "wall stops", "stopped", "refused", "faults"},
              {}};
  for (const Json& row : stability) {
    std::vector<Cell> cells = {cell_text(row, "part")};
    for (auto column = table.columns.begin() + 1; column != table.columns.end(); ++column) {
      cells.emplace_back(row.at(*column).get<std::uint64_t>());
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Table race_table(const Json& race) {
  Table table{{"dam break", "particles", "threads", "vat [s]", "SPlisHSPlasH [s]", "ratio",
               "density error", "machine"},
              {}};
  for (const Json& row : race) {
    table.rows.push_back({cell_text(row, "case"), row.at("particles").get<std::uint64_t>(),
                          row.at("threads").get<std::uint64_t>(), cell_number(row, "vat [s/s]"),
                          cell_number(row, "SPlisHSPlasH [s/s]"),
                          cell_number(row, "SPlisHSPlasH / vat"),
                          cell_number(row, "density error of vat [%]") + " %", machine_cell(row)});
  }
  return table;
}

Table device_cases_table(const Json& rows) {
  Table table{{"case", "rows on the device", "metric closest to its tolerance", "error",
               "error of the CPU", "reference and tolerance", "refused"},
              {}};
  for (const std::vector<Json>& group : by_case(rows)) {
    std::vector<Json> computed;
    std::set<std::string> reasons;
    for (const Json& row : group) {
      const std::string reason = cell_text(row, "refused");
      reason.empty() ? computed.push_back(row) : void(reasons.insert(reason));
    }
    std::string refused;
    for (const std::string& reason : reasons) refused += (refused.empty() ? "" : ", ") + reason;
    const std::string count =
        std::to_string(computed.size()) + " of " + std::to_string(group.size());
    if (computed.empty()) {
      table.rows.push_back({cell_text(group[0], "case"), count, "–", "–", "–", "–", refused});
      continue;
    }
    const Json& main = *std::ranges::max_element(computed, [](const Json& a, const Json& b) {
      return std::pair(is_judged(a), share(a)) < std::pair(is_judged(b), share(b));
    });
    table.rows.push_back({cell_text(main, "case"), count, cell_text(main, "metric"),
                          cell_number(main, "error"), cell_number(main, "error of the CPU"),
                          cell_text(main, "must be"), refused.empty() ? "–" : refused});
  }
  return table;
}

Table devices_table(const Json& speed) {
  Table table{{"case", "particles", "device", "ms per step", "threads of the CPU",
               "ms per step of the CPU", "speed / that of the CPU", "machine"},
              {}};
  for (const std::vector<Json>& group : by_case(speed)) {
    const auto threads = [](const Json& row) { return row.at("threads").get<std::uint64_t>(); };
    const auto time = [](const Json& row) { return row.at("wall s per simulated s").get<Real>(); };
    const Json& cpu = *std::ranges::max_element(group, {}, threads);
    for (const Json& row : group) {
      if (threads(row) > 0) continue;
      table.rows.push_back({cell_text(row, "case"), row.at("particles").get<std::uint64_t>(),
                            cell_text(row, "instruction set"), cell_number(row, "ms per step"),
                            threads(cpu), cell_number(cpu, "ms per step"),
                            three_digits(time(cpu) / time(row)), machine_cell(row)});
    }
  }
  return table;
}

Table kernels_table(const Json& kernels) {
  constexpr const char* kFigures[] = {"runs per step", "single",         "double",
                                      "instructions",  "accessed bytes", "bytes of groups",
                                      "distinct bytes"};
  Table table{{"scene", "kernel"}, {}};
  table.columns.insert(table.columns.end(), std::begin(kFigures), std::end(kFigures));
  for (const Json& row : kernels) {
    std::vector<Cell> cells{cell_text(row, "scene"), '`' + cell_text(row, "kernel") + '`'};
    for (const char* figure : kFigures) {
      cells.emplace_back(three_digits_or_whole(row.at(figure).get<Real>()));
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Table times_table(const Json& times) {
  Table table{{"scene"}, {}};
  for (const Json& row : times) {
    std::vector<Cell> cells{cell_text(row, "scene")};
    for (const auto& [column, value] : row.items()) {
      if (!value.is_number()) continue;
      if (table.rows.empty()) table.columns.push_back(column);
      cells.emplace_back(three_digits(value.get<Real>()));
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Table rounding_table(const Json& rounding) {
  Table table{{"scene", "quantity", "device", "steps", "change", "change on the CPU", "bound"}, {}};
  for (const Json& row : rounding) {
    table.rows.push_back({cell_text(row, "scene"), cell_text(row, "quantity"),
                          cell_text(row, "device"), row.at("steps").get<std::uint64_t>(),
                          cell_number(row, "change"), cell_number(row, "change on the CPU"),
                          cell_number(row, "bound")});
  }
  return table;
}

Table durability_table(const Json& durability) {
  constexpr const char* kTimes[] = {"median reply [ms]", "99 % reply [ms]", "median lateness [ms]",
                                    "99 % lateness [ms]"};
  Table table{{"sessions", "durability"}, {}};
  table.columns.insert(table.columns.end(), std::begin(kTimes), std::end(kTimes));
  table.columns.emplace_back("machine");
  for (const Json& row : durability) {
    std::vector<Cell> cells{row.at("sessions").get<std::uint64_t>(), cell_text(row, "durability")};
    for (const char* column : kTimes) cells.emplace_back(cell_number(row, column));
    cells.emplace_back(machine_cell(row));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Table recovery_table(const Json& recovery) {
  constexpr const char* kFigures[] = {"ticks per second", "written [GB/day]", "median recovery [s]",
                                      "longest recovery [s]"};
  Table table{{"particles", "kills"}, {}};
  table.columns.insert(table.columns.end(), std::begin(kFigures), std::end(kFigures));
  table.columns.emplace_back("machine");
  for (const Json& row : recovery) {
    std::vector<Cell> cells{row.at("particles").get<std::uint64_t>(),
                            row.at("kills").get<std::uint64_t>()};
    for (const char* column : kFigures) cells.emplace_back(cell_number(row, column));
    cells.emplace_back(machine_cell(row));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Table faults_table(const Json& faults) {
  Table table{{"measure", "value", "bound", "machine"}, {}};
  for (const Json& row : faults) {
    table.rows.push_back({cell_text(row, "measure"), row.at("value").get<Real>(),
                          cell_text(row, "bound"), machine_cell(row)});
  }
  return table;
}

}  // namespace vat::bench
