#include "tests/bench/speed_report.h"

#include <array>
#include <iomanip>
#include <sstream>

#include "server/output/text.h"
#include "tests/bench/report/table.h"

namespace vat::bench {

namespace {

std::string rounded(Real value, int digits) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(digits) << value;
  return text.str();
}

constexpr std::size_t kColumnCount = 11;
constexpr std::array<int, kColumnCount> kWidths = {24, 18, 10, 8, 8, 7, 10, 10, 16, 10, 27};

void print_columns(std::ostream& out, const std::array<std::string, kColumnCount>& texts) {
  for (std::size_t i = 0; i < kColumnCount; ++i) {
    out << (i < 2 ? std::left : std::right) << std::setw(kWidths[i]) << texts[i];
  }
  out << std::endl;  // a row takes seconds: show it at once
}

}  // namespace

void print_speed_header(std::ostream& out) {
  print_columns(out, {"scene", "integrator", "particles", "springs", "threads", "steps", "ms/step",
                      "min", "part. steps/s", "real time", "hash"});
}

void print_speed_row(std::ostream& out, const SpeedRow& row) {
  print_columns(out, {row.scene, row.integrator, std::to_string(row.particles),
                      std::to_string(row.springs), std::to_string(row.threads),
                      std::to_string(row.steps), rounded(row.median_ms_per_step, 4),
                      rounded(row.min_ms_per_step, 4), rounded(row.particle_steps_per_second(), 0),
                      rounded(row.real_time_factor(), 2), hash_text(row.state_hash)});
}

std::string speed_csv_header() {
  return "scene,integrator,particles,springs,threads,steps,ms_per_step_median,ms_per_step_min,"
         "particle_steps_per_second,real_time_factor,state_hash,instruction_set\n";
}

std::string speed_csv_row(const SpeedRow& row) {
  std::string text;
  append_csv_field(text, row.scene);
  text += ',' + row.integrator;
  for (const std::uint64_t count : {std::uint64_t{row.particles}, std::uint64_t{row.springs},
                                    std::uint64_t{row.threads}, row.steps}) {
    text += ',' + std::to_string(count);
  }
  for (const Real value : {row.median_ms_per_step, row.min_ms_per_step,
                           row.particle_steps_per_second(), row.real_time_factor()}) {
    text += ',';
    append_number(text, value);
  }
  text += ',';
  append_hash(text, row.state_hash);
  return text + ',' + to_string(row.instructions) + '\n';
}

}  // namespace vat::bench
