#include <algorithm>
#include <array>
#include <cmath>

#include "core/limits.h"
#include "protocol/scene/mesh_parts.h"

namespace vat::mesh_parts {
namespace {

[[noreturn]] void ply_fault(const std::string& text) {
  throw Fault{"not a readable .ply file: " + text};
}

enum class Format { text, little_endian, big_endian };
enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct Property {
  std::string_view name;
  Type type = Type::float32;
  std::optional<Type> length;  ///< type of the number of values; only for lists
};

struct Element {
  std::string_view name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

Type type_of(std::string_view name) {
  constexpr std::string_view kNames[][2] = {
      {"char", "int8"}, {"uchar", "uint8"}, {"short", "int16"},   {"ushort", "uint16"},
      {"int", "int32"}, {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"}};
  for (std::size_t t = 0; t < std::size(kNames); ++t) {
    if (name == kNames[t][0] || name == kNames[t][1]) return static_cast<Type>(t);
  }
  ply_fault("'" + std::string(name) + "' is not a type");
}

/// The values behind the header.
class Values {
 public:
  Values(std::string_view bytes, Format format) : bytes_(bytes), format_(format) {}

  double next(Type type) {
    if (format_ == Format::text) {
      const std::optional<double> number = to_number(take_word(bytes_));
      if (!number) ply_fault("a number is missing");
      return *number;
    }
    switch (type) {
      case Type::int8:
        return binary<std::int8_t>();
      case Type::uint8:
        return binary<std::uint8_t>();
      case Type::int16:
        return binary<std::int16_t>();
      case Type::uint16:
        return binary<std::uint16_t>();
      case Type::int32:
        return binary<std::int32_t>();
      case Type::uint32:
        return binary<std::uint32_t>();
      case Type::float32:
        return binary<float>();
      case Type::float64:
        return binary<double>();
    }
    ply_fault("an unknown type");
  }

  /// Returns a number of values or vertices.
  std::size_t next_count(Type type, std::size_t most) {
    const double value = next(type);
    if (!(value >= 0 && value <= static_cast<double>(most)) || value != std::floor(value)) {
      ply_fault("a number of vertices, or the number of a vertex, is out of range");
    }
    return static_cast<std::size_t>(value);
  }

  bool is_at_end() const { return bytes_.empty(); }

 private:
  template <class Number>
  double binary() {
    const auto number = take<Number>(bytes_, format_ == Format::big_endian);
    if (!number) ply_fault("the file is too short");
    return static_cast<double>(*number);
  }

  std::string_view bytes_;
  Format format_;
};

std::string_view take_line(std::string_view& bytes) {
  const std::size_t end = bytes.find('\n');
  if (end == std::string_view::npos) ply_fault("'end_header' is missing");
  std::string_view line = bytes.substr(0, end);
  bytes.remove_prefix(end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

Format format_of(std::string_view name) {
  if (name == "ascii") return Format::text;
  if (name == "binary_little_endian") return Format::little_endian;
  if (name == "binary_big_endian") return Format::big_endian;
  ply_fault("'" + std::string(name) + "' is not a format");
}

Property read_property(std::string_view line) {
  Property property;
  std::string_view word = take_word(line);
  if (word == "list") {
    property.length = type_of(take_word(line));
    word = take_word(line);
  }
  property.type = type_of(word);
  property.name = take_word(line);
  return property;
}

struct Header {
  Format format = Format::text;
  std::vector<Element> elements;
};

/// Removes the header from the bytes.
Header read_header(std::string_view& bytes) {
  if (take_line(bytes) != "ply") ply_fault("the first line is not 'ply'");
  Header header;
  for (;;) {
    std::string_view line = take_line(bytes);
    const std::string_view word = take_word(line);
    if (word == "end_header") return header;
    if (word == "format") {
      header.format = format_of(take_word(line));
    } else if (word == "element") {
      const std::string_view name = take_word(line);
      const std::optional<double> count = to_number(take_word(line));
      // A vertex has at least one byte.
      if (!count || !(*count >= 0 && *count <= 1e8) || *count != std::floor(*count)) {
        ply_fault("an element needs a number");
      }
      header.elements.push_back({name, static_cast<std::size_t>(*count), {}});
    } else if (word == "property") {
      if (header.elements.empty()) ply_fault("a property without an element");
      header.elements.back().properties.push_back(read_property(line));
    } else if (word != "comment" && word != "obj_info") {
      ply_fault("'" + std::string(word) + "' is unknown");
    }
  }
}

void read_vertices(const Element& element, Values& values, RawMesh& mesh) {
  constexpr std::array<std::string_view, 3> kAxes = {"x", "y", "z"};
  for (std::size_t v = 0; v < element.count; ++v) {
    Vec3 vertex = Vec3::Constant(std::nan(""));
    for (const Property& property : element.properties) {
      if (property.length) ply_fault("a vertex has a list");
      const double value = values.next(property.type);
      const auto axis = std::ranges::find(kAxes, property.name) - kAxes.begin();
      if (axis < 3) vertex[axis] = value;
    }
    if (vertex.hasNaN()) ply_fault("a vertex needs x, y and z");
    mesh.vertices.push_back(vertex);
  }
}

/// Splits a polygon into triangles with its first corner.
void add_polygon(const std::vector<Index>& corners, RawMesh& mesh) {
  for (std::size_t c = 2; c < corners.size(); ++c) {
    mesh.triangles.push_back({corners[0], corners[c - 1], corners[c]});
  }
  if (mesh.triangles.size() > kMaxMeshTriangles) {
    throw Fault{"has more than " + std::to_string(kMaxMeshTriangles) + " triangles"};
  }
}

void read_faces(const Element& element, Values& values, RawMesh& mesh) {
  std::vector<Index> corners;
  for (std::size_t f = 0; f < element.count; ++f) {
    for (const Property& property : element.properties) {
      const bool is_list = property.length.has_value();
      const std::size_t count =
          is_list ? values.next_count(*property.length, kMaxMeshTriangles) : 1;
      const bool has_corners =
          is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
      corners.clear();
      for (std::size_t i = 0; i < count; ++i) {
        if (!has_corners) {
          values.next(property.type);
        } else if (mesh.vertices.empty()) {
          ply_fault("a face without vertices");
        } else {
          corners.push_back(
              static_cast<Index>(values.next_count(property.type, mesh.vertices.size() - 1)));
        }
      }
      add_polygon(corners, mesh);
    }
  }
}

/// Reads over an element that is neither a vertex nor a face.
void skip(const Element& element, Values& values) {
  for (std::size_t e = 0; e < element.count && !element.properties.empty(); ++e) {
    for (const Property& property : element.properties) {
      const std::size_t count =
          property.length ? values.next_count(*property.length, kMaxMeshTriangles) : 1;
      for (std::size_t i = 0; i < count; ++i) values.next(property.type);
    }
  }
}

}  // namespace

RawMesh read_ply(std::string_view bytes) {
  const Header header = read_header(bytes);
  Values values(bytes, header.format);
  RawMesh mesh;
  for (const Element& element : header.elements) {
    if (element.name == "vertex") {
      read_vertices(element, values, mesh);
    } else if (element.name == "face") {
      read_faces(element, values, mesh);
    } else {
      skip(element, values);
    }
  }
  return mesh;
}

}  // namespace vat::mesh_parts
