#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// Readers of the program's output files, written from the descriptions of the formats. They throw
/// if a file violates its format.
namespace vat::test {

/// A CSV file with a header row.
struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;

  const std::string& text(std::size_t row, std::string_view column) const;
  double number(std::size_t row, std::string_view column) const;
};
Table read_csv(const std::string& path);

/// Runs `vat bench` with these arguments, and returns its table of this name. Fails the test if the
/// exit code is not 0.
Table bench_table(const std::string& name, std::vector<std::string> arguments);

/// A NumPy array of float64.
struct Array {
  std::vector<std::size_t> shape;
  std::vector<double> values;
};
Array read_npy(const std::string& path);

struct PlyVertex {
  float values[7];  // x, y, z, vx, vy, vz, radius
  std::uint8_t colour[3];
  std::uint32_t body;
};
std::vector<PlyVertex> read_ply(const std::string& path);

struct VtuFile {
  double time = 0;
  std::vector<double> points;
  std::vector<double> body, kind, radius, density, pressure;
  std::vector<double> velocity;
};
VtuFile read_vtu(const std::string& path);

/// Parses the complete text as a number.
double parse_number(std::string_view text);

}  // namespace vat::test
