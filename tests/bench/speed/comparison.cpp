#include "tests/bench/speed/comparison.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>

namespace vat::bench {

namespace {

/// The cells of a row by the names of their columns.
class RowReader {
 public:
  RowReader(const CsvFile& file, std::size_t row) : file_(file), row_(row) {}

  std::string text(std::string_view column) {
    const auto found = std::ranges::find(file_.columns, column);
    if (found != file_.columns.end()) {
      return file_.rows[row_][static_cast<std::size_t>(found - file_.columns.begin())];
    }
    errors_.push_back(
        {"missing", "",
         "has no column '" + std::string(column) + "': it is not a speed.csv of vat bench speed"});
    return "";
  }

  Real positive(std::string_view column) {
    const std::string cell = text(column);
    Real value = 0;
    const char* end = cell.data() + cell.size();
    const auto [rest, error] = std::from_chars(cell.data(), end, value);
    if (errors_.empty() &&
        (error != std::errc{} || rest != end || !(value > 0) || !std::isfinite(value))) {
      errors_.push_back({"malformed", "",
                         "row " + std::to_string(row_ + 2) + ": '" + std::string(column) +
                             "' must be a number above 0, and is '" + cell + "'"});
    }
    return value;
  }

  const Errors& errors() const { return errors_; }

 private:
  const CsvFile& file_;
  std::size_t row_;
  Errors errors_;
};

Result<TimedRow> read_row(const CsvFile& file, std::size_t index) {
  RowReader reader(file, index);
  TimedRow row;
  row.name = reader.text("case");
  row.threads = reader.text("threads");
  row.instruction_set = reader.text("instruction set");
  row.wall_per_simulated = reader.positive("wall s per simulated s");
  row.ms_per_step = reader.positive("ms per step");
  row.least_ms_per_step = reader.positive("least ms per step");
  row.steps = reader.text("steps");
  row.state_hash = reader.text("state hash");
  row.machine = reader.text("cpu") + ", cores: " + reader.text("cores");
  row.commit = reader.text("commit");
  if (!reader.errors().empty()) return reader.errors();
  return row;
}

const TimedRow* find_run(const std::vector<TimedRow>& rows, const TimedRow& wanted) {
  const auto found =
      std::ranges::find_if(rows, [&](const TimedRow& row) { return row.is_same_run(wanted); });
  return found == rows.end() ? nullptr : &*found;
}

Comparison::Pair pair_of(const TimedRow& before, const TimedRow& after, Real tolerance) {
  Comparison::Pair pair{before, after};
  pair.ratio = after.wall_per_simulated / before.wall_per_simulated;
  // Both times are for the same number of steps as the medians.
  pair.least_ratio = pair.ratio * (after.least_ms_per_step / after.ms_per_step) /
                     (before.least_ms_per_step / before.ms_per_step);
  pair.slower = std::min(pair.ratio, pair.least_ratio) > 1 + tolerance;
  pair.faster = std::max(pair.ratio, pair.least_ratio) < 1 / (1 + tolerance);
  return pair;
}

std::string verdict_of(const Comparison::Pair& pair) {
  if (pair.slower) return "SLOWER";
  return pair.faster ? "faster" : "";
}

}  // namespace

bool TimedRow::is_same_run(const TimedRow& other) const {
  return name == other.name && threads == other.threads && instruction_set == other.instruction_set;
}

std::string TimedRow::title() const {
  return name + ", " + threads + (threads == "1" ? " thread, " : " threads, ") + instruction_set;
}

Result<std::vector<TimedRow>> timed_rows(const CsvFile& file) {
  std::vector<TimedRow> rows;
  for (std::size_t i = 0; i < file.rows.size(); ++i) {
    Result<TimedRow> row = read_row(file, i);
    if (!row) return row.errors();
    if (find_run(rows, row.value()) != nullptr) {
      return Error{"duplicate", "",
                   "row " + std::to_string(i + 2) + ": " + row.value().title() + " comes twice"};
    }
    rows.push_back(std::move(row).value());
  }
  if (rows.empty()) return Error{"missing", "", "has no rows"};
  return rows;
}

Result<Comparison> compare_rows(const std::vector<TimedRow>& before,
                                const std::vector<TimedRow>& after, Real tolerance) {
  Comparison comparison;
  for (const TimedRow& row : before) {
    if (const TimedRow* other = find_run(after, row)) {
      comparison.pairs.push_back(pair_of(row, *other, tolerance));
    } else {
      comparison.only_before.push_back(row);
    }
  }
  for (const TimedRow& row : after) {
    if (find_run(before, row) == nullptr) comparison.only_after.push_back(row);
  }
  if (comparison.pairs.empty()) {
    return Error{"missing", "", "no case, number of threads and instruction set is in both files"};
  }
  return comparison;
}

std::size_t Comparison::slower_count() const {
  return static_cast<std::size_t>(std::ranges::count_if(pairs, &Pair::slower));
}

Real Comparison::mean_ratio() const {
  Real sum = 0;
  for (const Pair& pair : pairs) sum += std::log(pair.ratio);
  return std::exp(sum / static_cast<Real>(pairs.size()));
}

Table comparison_table(const Comparison& comparison) {
  Table table{{"case", "threads", "instruction set", "before [s/s]", "after [s/s]",
               "after / before", "by least", "steps", "state", "verdict"},
              {}};
  for (const Comparison::Pair& pair : comparison.pairs) {
    const auto& [before, after, ratio, least_ratio, slower, faster] = pair;
    const std::string steps =
        before.steps == after.steps ? std::string("same") : before.steps + " to " + after.steps;
    table.rows.push_back({before.name, before.threads, before.instruction_set,
                          before.wall_per_simulated, after.wall_per_simulated, ratio, least_ratio,
                          steps, before.state_hash == after.state_hash ? "same" : "changed",
                          verdict_of(pair)});
  }
  return table;
}

}  // namespace vat::bench
