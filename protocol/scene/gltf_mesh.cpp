#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "core/limits.h"
#include "protocol/json/json_reader.h"
#include "protocol/scene/mesh_file.h"
#include "protocol/scene/mesh_parts.h"

// glTF 2.0 specification: https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html
namespace vat::mesh_parts {
namespace {

[[noreturn]] void gltf_fault(const std::string& text) {
  throw Fault{"not a readable glTF file: " + text};
}

constexpr std::uint32_t kMagic = 0x46546C67;   // "glTF"
constexpr std::uint32_t kJson = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinary = 0x004E4942;  // "BIN"
constexpr std::size_t kMaxInstances = 10'000;  // of scenes and meshes
constexpr std::size_t kMaxBuffers = 64;
constexpr JsonLimits kGltfLimits{.bytes = kMaxMeshBytes, .depth = 32, .values = 1'000'000};

/// The bytes of a number in an accessor, by componentType.
constexpr int kUint8 = 5121;
constexpr int kUint16 = 5123;
constexpr int kUint32 = 5125;
constexpr int kFloat = 5126;

struct Document {
  Json json;
  std::string_view binary;          ///< the buffer in a .glb file
  std::vector<std::string> loaded;  ///< the other buffers
  std::vector<std::string_view> buffers;
};

void check_document(const Document& document) {
  if (!document.json.is_object()) gltf_fault("it has no JSON object");
  if (document.json.contains("extensionsRequired")) gltf_fault("it requires extensions");
}

Json read_json(std::string_view text) {
  Result<Json> json = parse_json(text, kGltfLimits);
  if (!json) gltf_fault(json.errors().front().message);
  return std::move(json).value();
}

Document read_container(std::string_view bytes) {
  const auto magic = take<std::uint32_t>(bytes);
  const auto version = take<std::uint32_t>(bytes);
  take<std::uint32_t>(bytes);  // the length of the file
  if (magic != kMagic || version != 2) gltf_fault("it needs version 2 of binary glTF");
  Document document;
  while (!bytes.empty()) {
    const auto size = take<std::uint32_t>(bytes);
    const auto type = take<std::uint32_t>(bytes);
    if (!size || !type || *size > bytes.size()) gltf_fault("the file is too short");
    const std::string_view chunk = bytes.substr(0, *size);
    bytes.remove_prefix(*size);
    if (type == kBinary && document.binary.empty()) document.binary = chunk;
    if (type == kJson && document.json.is_null()) document.json = read_json(chunk);
  }
  return document;
}

/// Returns a member, or null if it is absent.
const Json& member(const Json& object, const char* name) {
  static const Json kNull;
  if (!object.is_object()) gltf_fault(std::string("'") + name + "' belongs to an object");
  const auto found = object.find(name);
  return found == object.end() ? kNull : *found;
}

/// Returns an integer from 0 to `most`. `missing` is the value of an absent member.
std::size_t count_in(const Json& object, const char* name, std::size_t most,
                     std::optional<std::size_t> missing = {}) {
  const Json& value = member(object, name);
  if (value.is_null() && missing) return *missing;
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > most) {
    gltf_fault(std::string("'") + name + "' must be an integer from 0 to " + std::to_string(most));
  }
  return value.get<std::size_t>();
}

/// Returns the entry of an array of the document.
const Json& entry(const Document& document, const char* array, std::size_t index) {
  const Json& entries = member(document.json, array);
  if (!entries.is_array() || index >= entries.size()) {
    gltf_fault(std::string("an entry of '") + array + "' does not exist");
  }
  return entries[index];
}

/// Returns the value of a character of base64, or nothing.
std::optional<std::uint32_t> base64_value(char c) {
  constexpr std::string_view kAlphabet =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t value = kAlphabet.find(c);
  return value == std::string_view::npos ? std::nullopt
                                         : std::optional(static_cast<std::uint32_t>(value));
}

std::string decode_base64(std::string_view text) {
  while (text.ends_with('=')) text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const auto value = base64_value(c);
    if (!value) gltf_fault("the data of a buffer are not base64");
    bits = bits << 6 | *value;
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 255);
  }
  return bytes;
}

/// Returns a URI without its escapes, such as %20.
std::string unescape(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned code = 0;
    const char* const digits = uri.data() + i + 1;
    const bool is_escape = uri[i] == '%' && i + 2 < uri.size() &&
                           std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2;
    text += is_escape ? static_cast<char>(code) : uri[i];
    if (is_escape) i += 2;
  }
  return text;
}

/// Returns the content of a data: URI, or of a file in the folder of the mesh.
std::string load_buffer(const std::string& uri, const std::string& folder, const MeshFiles& files) {
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || !uri.substr(0, comma).ends_with(";base64")) {
      gltf_fault("the data: URI of a buffer needs base64");
    }
    return decode_base64(std::string_view(uri).substr(comma + 1));
  }
  if (!files) gltf_fault("it needs its buffer in the file");
  Result<std::string> bytes = files(folder + unescape(uri));
  if (!bytes) throw Fault{"its buffer " + bytes.errors().front().message};
  return std::move(bytes).value();
}

/// Finds the buffers of the document, in the file itself or by their URIs.
void open_buffers(Document& document, const std::string& folder, const MeshFiles& files) {
  const Json& list = member(document.json, "buffers");
  if (list.is_null()) return;
  if (!list.is_array() || list.size() > kMaxBuffers) {
    gltf_fault("'buffers' must be a list of at most " + std::to_string(kMaxBuffers));
  }
  std::size_t total = document.binary.size();
  document.loaded.reserve(list.size());  // views remain valid
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Json& uri = member(list[i], "uri");
    if (uri.is_null()) {
      document.buffers.push_back(i == 0 ? document.binary : std::string_view());
      continue;
    }
    if (!uri.is_string()) gltf_fault("'uri' must be a text");
    document.loaded.push_back(load_buffer(uri.get<std::string>(), folder, files));
    document.buffers.emplace_back(document.loaded.back());
    total += document.loaded.back().size();
    if (total > kMaxMeshBytes) {
      gltf_fault("its buffers have more than " + std::to_string(kMaxMeshBytes) + " bytes");
    }
  }
}

/// The numbers of an accessor, which has `components` numbers of a type per element.
class Accessor {
 public:
  Accessor(const Document& document, std::size_t index, const char* type, std::size_t components) {
    constexpr std::size_t kMost = 0xFFFFFFFF;
    const Json& accessor = entry(document, "accessors", index);
    if (member(accessor, "type") != type || accessor.contains("sparse")) {
      gltf_fault(std::string("an accessor must be a dense ") + type);
    }
    count_ = count_in(accessor, "count", kMost);
    component_ = static_cast<int>(count_in(accessor, "componentType", kMost));
    const Json& view = entry(document, "bufferViews", count_in(accessor, "bufferView", kMost));
    const std::size_t buffer_index = count_in(view, "buffer", kMost);
    if (buffer_index >= document.buffers.size()) gltf_fault("a buffer does not exist");
    const std::string_view buffer = document.buffers[buffer_index];
    const std::size_t begin = count_in(view, "byteOffset", kMost, 0);
    const std::size_t length = count_in(view, "byteLength", kMost);
    if (begin + length > buffer.size()) gltf_fault("a view is beyond the buffer");
    const std::size_t offset = count_in(accessor, "byteOffset", kMost, 0);
    const std::size_t element = components * component_bytes();
    stride_ = count_in(view, "byteStride", 252, element);
    bytes_ = buffer.substr(begin, length);
    if (stride_ < element || count_ > kMaxMeshBytes ||
        (count_ > 0 && offset + stride_ * (count_ - 1) + element > length)) {
      gltf_fault("an accessor is beyond its view");
    }
    bytes_.remove_prefix(std::min(offset, bytes_.size()));
  }

  std::size_t count() const { return count_; }
  int component() const { return component_; }

  std::size_t integer(std::size_t element) const {
    std::string_view at = bytes_.substr(element * stride_);
    if (component_ == kUint8) return *take<std::uint8_t>(at);
    if (component_ == kUint16) return *take<std::uint16_t>(at);
    return *take<std::uint32_t>(at);
  }

  Vec3 vector(std::size_t element) const {
    std::string_view at = bytes_.substr(element * stride_);
    Vec3 vector;
    for (Real& value : vector) value = static_cast<Real>(*take<float>(at));
    return vector;
  }

 private:
  std::size_t component_bytes() const {
    switch (component_) {
      case kUint8:
        return 1;
      case kUint16:
        return 2;
      case kUint32:
      case kFloat:
        return 4;
      default:
        gltf_fault("an accessor has another type of numbers");
    }
  }

  std::string_view bytes_;
  std::size_t count_ = 0;
  int component_ = 0;
  std::size_t stride_ = 0;
};

/// Affine transformation x -> linear x + offset.
struct Transform {
  Mat3 linear = Mat3::Identity();
  Vec3 offset = Vec3::Zero();
};

/// Returns the numbers of a member, or nothing if it is absent.
template <std::size_t kCount>
std::optional<std::array<Real, kCount>> numbers_in(const Json& object, const char* name) {
  const Json& value = member(object, name);
  if (value.is_null()) return {};
  const auto is_number = [](const Json& each) { return each.is_number(); };
  if (!value.is_array() || value.size() != kCount || !std::ranges::all_of(value, is_number)) {
    gltf_fault(std::string("'") + name + "' needs " + std::to_string(kCount) + " numbers");
  }
  return value.get<std::array<Real, kCount>>();
}

Transform transform_of(const Json& node) {
  Transform transform;
  if (const auto matrix = numbers_in<16>(node, "matrix")) {  // by columns
    for (int column = 0; column < 4; ++column) {
      for (int row = 0; row < 3; ++row) {
        const Real value = (*matrix)[static_cast<std::size_t>(4 * column + row)];
        if (column < 3) transform.linear(row, column) = value;
        if (column == 3) transform.offset[row] = value;
      }
    }
    return transform;
  }
  if (const auto rotation = numbers_in<4>(node, "rotation")) {
    const auto [x, y, z, w] = *rotation;
    transform.linear = Quat(w, x, y, z).normalized().toRotationMatrix();
  }
  if (const auto scale = numbers_in<3>(node, "scale")) {
    transform.linear *= Vec3((*scale)[0], (*scale)[1], (*scale)[2]).asDiagonal();
  }
  if (const auto offset = numbers_in<3>(node, "translation")) {
    transform.offset = Vec3((*offset)[0], (*offset)[1], (*offset)[2]);
  }
  return transform;
}

class GltfReader {
 public:
  GltfReader(Document document, const std::string& folder, const MeshFiles& files)
      : document_(std::move(document)) {
    check_document(document_);
    open_buffers(document_, folder, files);
    const Json& nodes = member(document_.json, "nodes");
    visited_.resize(nodes.is_array() ? nodes.size() : 0);
    const std::size_t scene = count_in(document_.json, "scene", kMaxInstances, 0);
    add_nodes(member(entry(document_, "scenes", scene), "nodes"), {});
  }

  RawMesh take_mesh() { return std::move(mesh_); }

 private:
  void add_nodes(const Json& nodes, const Transform& parent) {
    if (nodes.is_null()) return;
    if (!nodes.is_array()) gltf_fault("'nodes' and 'children' are lists");
    for (const Json& index : nodes) {
      if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= visited_.size()) {
        gltf_fault("a node does not exist");
      }
      add_node(index.get<std::size_t>(), parent);
    }
  }

  /// The nodes of a valid file are trees, whose depth the limit of nested calls bounds.
  void add_node(std::size_t index, const Transform& parent) {
    if (visited_[index] || ++depth_ > kMaxDepth)
      gltf_fault("its nodes are not trees of few levels");
    visited_[index] = true;
    const Json& node = entry(document_, "nodes", index);
    const Transform own = transform_of(node);
    const Transform whole{parent.linear * own.linear, parent.linear * own.offset + parent.offset};
    if (const Json& mesh = member(node, "mesh"); !mesh.is_null()) {
      add_mesh(entry(document_, "meshes", count_in(node, "mesh", kMaxInstances)), whole);
    }
    add_nodes(member(node, "children"), whole);
    --depth_;
  }

  void add_mesh(const Json& mesh, const Transform& transform) {
    const Json& primitives = member(mesh, "primitives");
    if (!primitives.is_array()) gltf_fault("a mesh needs 'primitives'");
    for (const Json& primitive : primitives) {
      constexpr std::size_t kTriangles = 4;
      const std::size_t mode = count_in(primitive, "mode", 6, kTriangles);
      if (mode < kTriangles) continue;  // points and lines
      if (mode > kTriangles) gltf_fault("strips and fans of triangles are not supported");
      add_primitive(primitive, transform);
    }
  }

  void add_primitive(const Json& primitive, const Transform& transform) {
    constexpr std::size_t kMost = 0xFFFFFFFF;
    const Accessor positions(
        document_, count_in(member(primitive, "attributes"), "POSITION", kMost), "VEC3", 3);
    if (positions.component() != kFloat) gltf_fault("positions must be float numbers");
    const std::size_t first = mesh_.vertices.size();
    if (first + positions.count() > 3 * kMaxMeshTriangles) gltf_fault("it has too many vertices");
    for (std::size_t v = 0; v < positions.count(); ++v) {
      const Vec3 vertex = transform.linear * positions.vector(v) + transform.offset;
      mesh_.vertices.emplace_back(vertex.x(), -vertex.z(), vertex.y());
    }
    const bool is_mirrored = transform.linear.determinant() < 0;
    if (member(primitive, "indices").is_null()) {
      const auto same = [](std::size_t corner) { return corner; };
      return add_triangles(positions.count(), positions.count(), first, is_mirrored, same);
    }
    const Accessor indices(document_, count_in(primitive, "indices", kMost), "SCALAR", 1);
    if (indices.component() == kFloat) gltf_fault("indices must be integers");
    add_triangles(indices.count(), positions.count(), first, is_mirrored,
                  [&](std::size_t corner) { return indices.integer(corner); });
  }

  template <class IndexOf>
  void add_triangles(std::size_t corners, std::size_t vertices, std::size_t first, bool is_mirrored,
                     const IndexOf& index_of) {
    if (mesh_.triangles.size() + corners / 3 > kMaxMeshTriangles) {
      throw Fault{"has more than " + std::to_string(kMaxMeshTriangles) + " triangles"};
    }
    for (std::size_t corner = 0; corner + 2 < corners; corner += 3) {
      std::array<Index, 3> triangle{};
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t vertex = index_of(corner + c);
        if (vertex >= vertices) gltf_fault("a face names a vertex that does not exist");
        triangle[c] = static_cast<Index>(first + vertex);
      }
      if (is_mirrored) std::swap(triangle[1], triangle[2]);
      mesh_.triangles.push_back(triangle);
    }
  }

  static constexpr std::size_t kMaxDepth = 64;

  Document document_;
  std::vector<bool> visited_;
  std::size_t depth_ = 0;
  RawMesh mesh_;
};

}  // namespace

RawMesh read_glb(std::string_view bytes, const std::string& folder, const MeshFiles& files) {
  return GltfReader(read_container(bytes), folder, files).take_mesh();
}

RawMesh read_gltf(std::string_view text, const std::string& folder, const MeshFiles& files) {
  Document document;
  document.json = read_json(text);
  return GltfReader(std::move(document), folder, files).take_mesh();
}

}  // namespace vat::mesh_parts
