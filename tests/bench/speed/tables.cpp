#include "tests/bench/speed/tables.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <string>

#include "protocol/files/text.h"

namespace vat::bench {

namespace {

constexpr std::size_t kColumnCount = 11;
constexpr std::array<int, kColumnCount> kWidths = {36, 10, 8, 7, 11, 11, 11, 11, 11, 10, 18};

void print_columns(std::ostream& out, const std::array<std::string, kColumnCount>& texts) {
  for (std::size_t i = 0; i < kColumnCount; ++i) {
    out << (i < 1 ? std::left : std::right) << std::setw(kWidths[i]) << texts[i];
  }
  out << std::endl;  // a row takes seconds, so it is shown immediately
}

std::string hash_of(const SpeedRow& row) {
  std::string text;
  append_hash(text, row.state_hash);
  return text;
}

std::string four_digits(Real value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", value);
  return std::isfinite(value) ? buffer : "-";
}

/// A column of speed_table().
struct Column {
  const char* name;
  Cell (*cell)(const SpeedRow& row);
};

constexpr Column kTableColumns[] = {
    {"case", [](const SpeedRow& row) -> Cell { return row.name; }},
    {"threads", [](const SpeedRow& row) -> Cell { return std::uint64_t{row.threads}; }},
    {"instruction set", [](const SpeedRow& row) -> Cell { return row.arithmetic(); }},
    {"solver", [](const SpeedRow& row) -> Cell { return row.solver; }},
    {"integrator", [](const SpeedRow& row) -> Cell { return row.integrator; }},
    {"control", [](const SpeedRow& row) -> Cell { return row.control; }},
    {"particles", [](const SpeedRow& row) -> Cell { return std::uint64_t{row.particles}; }},
    {"liquid particles",
     [](const SpeedRow& row) -> Cell { return std::uint64_t{row.liquid_particles}; }},
    {"springs", [](const SpeedRow& row) -> Cell { return std::uint64_t{row.springs}; }},
    {"repetitions", [](const SpeedRow& row) -> Cell { return std::uint64_t{row.seconds.size()}; }},
    {"steps", [](const SpeedRow& row) -> Cell { return row.steps; }},
    {"undone steps", [](const SpeedRow& row) -> Cell { return row.undone_steps; }},
    {"simulated [s]", [](const SpeedRow& row) -> Cell { return row.simulated; }},
    {"ms per step", [](const SpeedRow& row) -> Cell { return row.median_ms_per_step(); }},
    {"least ms per step", [](const SpeedRow& row) -> Cell { return row.least_ms_per_step(); }},
    {"particle steps per s",
     [](const SpeedRow& row) -> Cell { return row.particle_steps_per_second(); }},
    {"wall s per simulated s",
     [](const SpeedRow& row) -> Cell { return row.wall_per_simulated(); }},
    {"real-time factor", [](const SpeedRow& row) -> Cell { return row.real_time_factor(); }},
    {"neighbours", [](const SpeedRow& row) -> Cell { return row.flow.neighbours; }},
    {"density error", [](const SpeedRow& row) -> Cell { return row.flow.density_error; }},
    {"greatest density error",
     [](const SpeedRow& row) -> Cell { return row.flow.greatest_density_error; }},
    {"velocity iterations",
     [](const SpeedRow& row) -> Cell { return row.flow.velocity_iterations; }},
    {"place iterations", [](const SpeedRow& row) -> Cell { return row.flow.place_iterations; }},
    {"bytes per particle", [](const SpeedRow& row) -> Cell { return row.bytes_per_particle; }},
    {"bytes per particle with diagnostics",
     [](const SpeedRow& row) -> Cell { return row.bytes_with_diagnostics; }},
    {"creation [s]", [](const SpeedRow& row) -> Cell { return row.creation; }},
    {"state hash", [](const SpeedRow& row) -> Cell { return hash_of(row); }},
};

}  // namespace

Table speed_table(const std::vector<SpeedRow>& rows, const Machine& machine) {
  Table table;
  for (const Column& column : kTableColumns) table.columns.emplace_back(column.name);
  for (const char* name : {"commit", "cpu", "cores"}) table.columns.emplace_back(name);
  for (const SpeedRow& row : rows) {
    std::vector<Cell>& cells = table.rows.emplace_back();
    for (const Column& column : kTableColumns) cells.push_back(column.cell(row));
    cells.insert(cells.end(), {machine.commit, machine.cpu, std::uint64_t{machine.cores}});
  }
  return table;
}

Table stage_table(const std::vector<SpeedRow>& rows) {
  Table table{{"case", "threads", "instruction set", "stage", "ms per step", "share"}, {}};
  for (const SpeedRow& row : rows) {
    const Real whole = row.seconds.front();
    Real rest = whole;
    const auto add = [&](const std::string& stage, Real seconds) {
      table.rows.push_back({row.name, std::uint64_t{row.threads}, row.arithmetic(), stage,
                            1e3 * seconds / static_cast<Real>(row.steps), seconds / whole});
    };
    for (const StageClock::Stage& stage : row.stages) {
      add(std::string(stage.name), stage.seconds());
      rest -= stage.seconds();
    }
    add("rest", rest);
  }
  return table;
}

void print_speed_header(std::ostream& out) {
  print_columns(out, {"case", "particles", "threads", "steps", "ms/step", "least", "wall s/s",
                      "real time", "dens. %", "set", "hash"});
}

void print_speed_row(std::ostream& out, const SpeedRow& row) {
  print_columns(out, {row.name, std::to_string(row.particles), std::to_string(row.threads),
                      std::to_string(row.steps), four_digits(row.median_ms_per_step()),
                      four_digits(row.least_ms_per_step()), four_digits(row.wall_per_simulated()),
                      four_digits(row.real_time_factor()),
                      four_digits(100 * row.flow.density_error), row.arithmetic(), hash_of(row)});
}

}  // namespace vat::bench
