#include "tests/cli/readers.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "tests/cli/program.h"

namespace vat::test {

namespace {

void require(bool condition, const std::string& what) {
  if (!condition) throw std::runtime_error(what);
}

// Splits a record of RFC 4180. Its fields contain no line breaks.
std::vector<std::string> split_record(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool next_is_quote = i + 1 < line.size() && line[i + 1] == '"';
    if (line[i] == '"' && quoted && next_is_quote) {
      fields.back() += '"';
      ++i;
    } else if (line[i] == '"') {
      quoted = !quoted;
    } else if (line[i] == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  require(!quoted, "open quote");
  return fields;
}

template <class T>
T take(std::string_view& bytes) {
  T value;
  require(bytes.size() >= sizeof value, "short file");
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes.remove_prefix(sizeof value);
  return value;
}

std::vector<double> read_values(std::istream& stream, std::size_t count) {
  std::vector<double> values(count);
  for (double& value : values) {
    std::string word;
    stream >> word;
    value = parse_number(word);
  }
  return values;
}

void expect_words(std::istream& stream, const std::string& words) {
  std::istringstream expected(words);
  for (std::string word, found; expected >> word;) {
    require(stream >> found && found == word, "expected " + word);
  }
}

std::vector<double> read_scalars(std::istream& stream, const std::string& declaration,
                                 std::size_t count) {
  expect_words(stream, "SCALARS " + declaration + " 1 LOOKUP_TABLE default");
  return read_values(stream, count);
}

}  // namespace

const std::string& Table::text(std::size_t row, std::string_view column) const {
  const auto found = std::ranges::find(columns, column);
  require(found != columns.end(), "no column " + std::string(column));
  return rows.at(row).at(static_cast<std::size_t>(found - columns.begin()));
}

double Table::number(std::size_t row, std::string_view column) const {
  return parse_number(text(row, column));
}

Table read_csv(const std::string& path) {
  const std::vector<std::string> lines = lines_of(read_file(path));
  require(!lines.empty(), "no header row");
  Table table{split_record(lines.front()), {}};
  for (std::size_t i = 1; i < lines.size(); ++i) {
    table.rows.push_back(split_record(lines[i]));
    require(table.rows.back().size() == table.columns.size(), "a row of another length");
  }
  return table;
}

Array read_npy(const std::string& path) {
  const std::string file = read_file(path);
  std::string_view bytes = file;
  require(bytes.starts_with(std::string_view("\x93NUMPY\x01\x00", 8)), "no NumPy file");
  bytes.remove_prefix(8);
  const auto header_size = take<std::uint16_t>(bytes);
  require((10 + header_size) % 64 == 0 && bytes.size() >= header_size, "bad header length");
  const std::string header(bytes.substr(0, header_size));
  bytes.remove_prefix(header_size);
  const std::string start = "{'descr': '<f8', 'fortran_order': False, 'shape': (";
  require(header.starts_with(start) && header.back() == '\n', "bad header");
  Array array;
  std::istringstream shape(header.substr(start.size()));
  char separator = ',';
  for (std::size_t extent = 0; separator == ',' && shape >> extent >> separator;) {
    array.shape.push_back(extent);
  }
  expect_words(shape, ", }");
  while (!bytes.empty()) array.values.push_back(take<double>(bytes));
  return array;
}

std::vector<PlyVertex> read_ply(const std::string& path) {
  const std::string file = read_file(path);
  const std::string end = "end_header\n";
  const std::size_t header_size = file.find(end) + end.size();
  const std::vector<std::string> header = lines_of(file.substr(0, header_size));
  const std::vector<std::string> properties = {
      "property float x",     "property float y",    "property float z",      "property float vx",
      "property float vy",    "property float vz",   "property float radius", "property uchar red",
      "property uchar green", "property uchar blue", "property uint body",    "end_header"};
  require(header.size() == 4 + properties.size() && header[0] == "ply" &&
              header[1] == "format binary_little_endian 1.0" &&
              std::equal(properties.begin(), properties.end(), header.begin() + 4),
          "unknown header");
  std::istringstream element(header[3]);
  expect_words(element, "element vertex");
  std::size_t count = 0;
  element >> count;
  std::vector<PlyVertex> vertices(count);
  std::string_view bytes = std::string_view(file).substr(header_size);
  for (PlyVertex& vertex : vertices) {
    for (float& value : vertex.values) value = take<float>(bytes);
    for (std::uint8_t& part : vertex.colour) part = take<std::uint8_t>(bytes);
    vertex.body = take<std::uint32_t>(bytes);
  }
  require(bytes.empty(), "more bytes than vertices");
  return vertices;
}

VtkFile read_vtk(const std::string& path) {
  std::istringstream stream(read_file(path));
  std::string line;
  std::getline(stream, line);
  require(line == "# vtk DataFile Version 3.0", "no VTK file");
  std::getline(stream, line);
  require(line.size() < 256, "long title");
  VtkFile file;
  std::size_t count = 0;
  expect_words(stream, "ASCII DATASET POLYDATA FIELD FieldData 1 TIME 1 1 double");
  file.time = read_values(stream, 1).front();
  expect_words(stream, "POINTS");
  stream >> count;
  expect_words(stream, "double");
  file.points = read_values(stream, 3 * count);
  expect_words(stream, "VERTICES " + std::to_string(count) + ' ' + std::to_string(2 * count));
  for (std::size_t i = 0; i < count; ++i) expect_words(stream, "1 " + std::to_string(i));
  expect_words(stream, "POINT_DATA " + std::to_string(count));
  file.body = read_scalars(stream, "body unsigned_int", count);
  file.kind = read_scalars(stream, "kind unsigned_char", count);
  file.radius = read_scalars(stream, "radius double", count);
  file.density = read_scalars(stream, "density double", count);
  file.pressure = read_scalars(stream, "pressure double", count);
  expect_words(stream, "VECTORS velocity double");
  file.velocity = read_values(stream, 3 * count);
  require(!(stream >> line), "text after the end");
  return file;
}

double parse_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  require(error == std::errc{} && end == text.data() + text.size() && !text.empty(),
          "'" + std::string(text) + "' is no number");
  return value;
}

}  // namespace vat::test
