#include "tests/cli/readers.h"

#include <lz4.h>

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

void expect_words(std::istream& stream, const std::string& words) {
  std::istringstream expected(words);
  for (std::string word, found; expected >> word;) {
    require(stream >> found && found == word, "expected " + word);
  }
}

/// Returns the text between `begin` and the next `end`.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin);
  require(from != std::string::npos, "no " + begin);
  const std::size_t to = text.find(end, from + begin.size());
  require(to != std::string::npos, "no " + end);
  return text.substr(from + begin.size(), to - from - begin.size());
}

/// Returns the array that begins with the sizes of its compressed blocks.
std::string decompressed(std::string_view bytes) {
  const auto count = take<std::uint64_t>(bytes);
  const auto whole = take<std::uint64_t>(bytes);
  const auto last = take<std::uint64_t>(bytes);
  std::vector<std::uint64_t> sizes(count);
  for (std::uint64_t& size : sizes) size = take<std::uint64_t>(bytes);
  std::string array;
  for (std::size_t i = 0; i < count; ++i) {
    std::string block(i + 1 == count && last > 0 ? last : whole, '\0');
    require(bytes.size() >= sizes[i], "an incomplete block");
    const int size = LZ4_decompress_safe(bytes.data(), block.data(), static_cast<int>(sizes[i]),
                                         static_cast<int>(block.size()));
    require(size == static_cast<int>(block.size()), "a block of another size");
    array += block;
    bytes.remove_prefix(sizes[i]);
  }
  return array;
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

Table bench_table(const std::string& name, std::vector<std::string> arguments) {
  const TemporaryFolder folder;
  arguments.insert(arguments.end(), {"--output", folder.path().string()});
  EXPECT_THAT(run_bench(arguments), exits(0, testing::_));
  return read_csv(folder.file(name + ".csv"));
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

VtuFile read_vtu(const std::string& path) {
  const std::string file = read_file(path);
  const std::string begin = "<AppendedData encoding=\"raw\">\n_";
  const std::size_t end = file.find(begin);
  require(end != std::string::npos, "no appended data");
  const std::string xml = file.substr(0, end);
  const std::string_view data = std::string_view(file).substr(end + begin.size());
  require(xml.find("type=\"UnstructuredGrid\"") != std::string::npos &&
              xml.find("header_type=\"UInt64\" compressor=\"vtkLZ4DataCompressor\"") !=
                  std::string::npos,
          "unknown header");
  VtuFile vtu;
  vtu.time = parse_number(between(xml, "format=\"ascii\">", "<"));
  const double count = parse_number(between(xml, "NumberOfPoints=\"", "\""));
  const auto array = [&]<class Number>(const char* name, const char* type, Number) {
    const std::string element =
        between(xml, "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + '"', "/>");
    const auto offset = parse_number(between(element, "offset=\"", "\""));
    std::string_view values = data.substr(static_cast<std::size_t>(offset));
    const std::string bytes = decompressed(values);
    values = bytes;
    std::vector<double> numbers;
    while (!values.empty()) numbers.push_back(static_cast<double>(take<Number>(values)));
    return numbers;
  };
  vtu.points = array("Points", "Float64", double());
  vtu.body = array("body", "UInt32", std::uint32_t());
  vtu.kind = array("kind", "UInt8", std::uint8_t());
  vtu.radius = array("radius", "Float64", double());
  vtu.density = array("density", "Float64", double());
  vtu.pressure = array("pressure", "Float64", double());
  vtu.velocity = array("velocity", "Float64", double());
  require(static_cast<double>(vtu.kind.size()) == count, "another number of points");
  const std::vector<double> cells = array("offsets", "Int32", std::int32_t());
  require(cells == std::vector<double>(count == 0 ? 0 : 1, count), "no cell of all points");
  const std::vector<double> points = array("connectivity", "Int32", std::int32_t());
  for (std::size_t i = 0; i < points.size(); ++i) {
    require(points[i] == static_cast<double>(i), "a cell without some points");
  }
  return vtu;
}

double parse_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  require(error == std::errc{} && end == text.data() + text.size() && !text.empty(),
          "'" + std::string(text) + "' is no number");
  return value;
}

}  // namespace vat::test
