#include "server/output/glb_document.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "server/output/bytes.h"

// glTF 2.0 specification: https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html
namespace vat {

namespace {

using nlohmann::json;

constexpr unsigned kUint32 = 5125;
constexpr unsigned kFloat32 = 5126;
constexpr int kVertices = 34962;
constexpr int kIndices = 34963;
constexpr int kNoTarget = 0;

/// Returns the linear part of a component in sRGB.
Real linear(std::uint8_t component) {
  const Real c = component / Real{255};
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

std::size_t add_to(json& list, json element) {
  list.push_back(std::move(element));
  return list.size() - 1;
}

/// Returns the floats as numbers whose shortest text is that of a float.
json float_list(std::span<const float> values) {
  json list = json::array();
  for (const float value : values) list.push_back(value);
  return list;
}

}  // namespace

GlbDocument::GlbDocument() {
  const Real half = std::sqrt(Real{0.5});
  json_ = {{"asset", {{"version", "2.0"}, {"generator", "vat"}}},
           {"scene", 0U},
           {"scenes", {{{"nodes", {0U}}}}},
           {"nodes", {{{"name", "z up"}, {"rotation", {-half, 0U, 0U, half}}}}}};
}

std::size_t GlbDocument::add_accessor(json accessor, int target) {
  json view = {
      {"buffer", 0U}, {"byteOffset", view_begin_}, {"byteLength", buffer_.size() - view_begin_}};
  if (target != kNoTarget) view["target"] = target;
  accessor["bufferView"] = add_to(json_["bufferViews"], std::move(view));
  view_begin_ = buffer_.size();
  return add_to(json_["accessors"], std::move(accessor));
}

void GlbDocument::append_floats(std::span<const float> values) {
  buffer_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

std::size_t GlbDocument::add_positions(std::span<const Vec3> positions) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::array<float, 3> min{kInfinity, kInfinity, kInfinity};
  std::array<float, 3> max{-kInfinity, -kInfinity, -kInfinity};
  buffer_.reserve(buffer_.size() + positions.size() * sizeof min);
  for (const Vec3& position : positions) {
    std::array<float, 3> point{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      point[axis] = static_cast<float>(position[static_cast<Eigen::Index>(axis)]);
      min[axis] = std::min(min[axis], point[axis]);
      max[axis] = std::max(max[axis], point[axis]);
    }
    append_floats(point);
  }
  return add_accessor({{"componentType", kFloat32},
                       {"count", positions.size()},
                       {"type", "VEC3"},
                       {"min", float_list(min)},
                       {"max", float_list(max)}},
                      kVertices);
}

std::size_t GlbDocument::add_indices(const std::vector<std::array<Index, 3>>& triangles) {
  for (const auto& triangle : triangles) {
    for (const Index corner : triangle) append_bytes(buffer_, static_cast<std::uint32_t>(corner));
  }
  return add_accessor(
      {{"componentType", kUint32}, {"count", 3 * triangles.size()}, {"type", "SCALAR"}}, kIndices);
}

std::size_t GlbDocument::add_times(const std::vector<float>& times) {
  append_floats(times);
  return add_accessor({{"componentType", kFloat32},
                       {"count", times.size()},
                       {"type", "SCALAR"},
                       {"min", float_list({&times.front(), 1})},
                       {"max", float_list({&times.back(), 1})}},
                      kNoTarget);
}

std::size_t GlbDocument::add_values(const char* type, const std::vector<float>& values) {
  const std::size_t components = std::string(type) == "VEC3" ? 3 : 4;
  append_floats(values);
  return add_accessor(
      {{"componentType", kFloat32}, {"count", values.size() / components}, {"type", type}},
      kNoTarget);
}

std::size_t GlbDocument::add_material(const std::string& name, const Colour& colour, Real opacity,
                                      Real roughness, Real metalness) {
  json material = {{"name", name},
                   {"pbrMetallicRoughness",
                    {{"baseColorFactor",
                      {linear(colour.red), linear(colour.green), linear(colour.blue), opacity}},
                     {"metallicFactor", metalness},
                     {"roughnessFactor", roughness}}}};
  if (opacity < 1) material["alphaMode"] = "BLEND";
  return add_to(json_["materials"], std::move(material));
}

std::size_t GlbDocument::add_mesh(const SurfaceMesh& surface, std::size_t material) {
  return add_mesh(json::array({triangles_of(surface, material)}));
}

json GlbDocument::triangles_of(const SurfaceMesh& surface, std::size_t material) {
  const std::size_t positions = add_positions(surface.vertices);
  return {{"attributes", {{"POSITION", positions}}},
          {"indices", add_indices(surface.triangles)},
          {"material", material}};
}

std::size_t GlbDocument::add_mesh(json primitives) {
  return add_to(json_["meshes"], {{"primitives", std::move(primitives)}});
}

std::size_t GlbDocument::add_node(json node) {
  const std::size_t index = add_to(json_["nodes"], std::move(node));
  json_["nodes"][0]["children"].push_back(index);
  return index;
}

void GlbDocument::animate(std::size_t node, const char* property, const char* interpolation,
                          std::size_t times, std::size_t values) {
  json& animation = json_["animations"][0];
  const std::size_t sampler =
      add_to(animation["samplers"],
             {{"input", times}, {"output", values}, {"interpolation", interpolation}});
  animation["channels"].push_back(
      {{"sampler", sampler}, {"target", {{"node", node}, {"path", property}}}});
}

std::string GlbDocument::bytes() const {
  json document = json_;
  if (!buffer_.empty()) document["buffers"] = {{{"byteLength", buffer_.size()}}};
  std::string text = document.dump(-1, ' ', false, json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  // Header and chunk headers have 12 and 8 bytes. All numbers of the buffer have 4 bytes.
  const std::size_t buffer_chunk = buffer_.empty() ? 0 : 8 + buffer_.size();
  const std::size_t size = 12 + 8 + text.size() + buffer_chunk;
  if (size > std::numeric_limits<std::uint32_t>::max()) return {};
  std::string file = "glTF";
  file.reserve(size);
  append_bytes(file, std::uint32_t{2});
  append_bytes(file, static_cast<std::uint32_t>(size));
  append_bytes(file, static_cast<std::uint32_t>(text.size()));
  file += "JSON" + text;
  if (buffer_.empty()) return file;
  append_bytes(file, static_cast<std::uint32_t>(buffer_.size()));
  return file + std::string("BIN\0", 4) + buffer_;
}

}  // namespace vat
