#include "server/script/frame_json.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace vat::script {
namespace {

/// The extent of a block's particles [m].
void add_bounds(const GridFrame& frame, const GridBlock& block, Json& json) {
  if (block.positions.empty()) return;
  std::array<std::uint16_t, 3> least{};
  std::array<std::uint16_t, 3> greatest{};
  least.fill(std::numeric_limits<std::uint16_t>::max());
  for (std::size_t i = 0; i < block.positions.size(); ++i) {
    least[i % 3] = std::min(least[i % 3], block.positions[i]);
    greatest[i % 3] = std::max(greatest[i % 3], block.positions[i]);
  }
  const FrameGrid& grid = frame.scale.grid;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    json["min"].push_back(grid.origin[axis] + grid.quantum * least[axis]);
    json["max"].push_back(grid.origin[axis] + grid.quantum * greatest[axis]);
  }
}

/// The least and greatest of each attribute that the block has [m/s, kg/m^3, Pa, m/s^2].
void add_attributes(const GridFrame& frame, const GridBlock& block, Json& json) {
  constexpr std::array<const char*, kFrameAttributes> kNames{"speed", "density", "pressure",
                                                             "acceleration"};
  for (std::size_t a = 0; a < kFrameAttributes; ++a) {
    const std::vector<std::int32_t>& values = block.attributes[a];
    if (values.empty()) continue;
    const auto [least, greatest] = std::ranges::minmax(values);
    const double quantum = frame.scale.attribute_quanta[a];
    json[kNames[a]] = {{"min", quantum * least}, {"max", quantum * greatest}};
  }
}

Json block_to_json(const GridFrame& frame, const GridBlock& block, const BodyNames& names) {
  constexpr std::array kKinds{"liquid", "deformable", "rigid", "vat"};
  Json json = {{"body", block.body}, {"kind", kKinds.at(static_cast<std::size_t>(block.kind))}};
  if (const auto name = names.find(block.body); name != names.end()) json["name"] = name->second;
  if (block.has_particles()) {
    json["particles"] = block.particle_count();
    json["grid_positions"] = block.positions;
    add_bounds(frame, block, json);
    add_attributes(frame, block, json);
    return json;
  }
  json["position"] = place_of(frame, block);
  if (block.kind == GridBlock::Kind::rigid) json["orientation"] = orientation_of(block);
  return json;
}

}  // namespace

Json frame_to_json(const std::string& bytes, FrameDecoder& decoder, const BodyNames& names) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  const Result<const GridFrame*> result = decoder.decode({data, bytes.size()});
  if (!result) {
    throw std::runtime_error("an invalid frame was received: " + result.errors().front().code +
                             ": " + result.errors().front().message);
  }
  const GridFrame& frame = *result.value();
  const FrameHeader& header = frame.header;
  Json json = {{"bytes", bytes.size()},
               {"key", is_key_frame({data, bytes.size()})},
               {"playing", header.playing},
               {"slow", header.slow},
               {"detail", frame.detail},
               {"region", frame.has_region},
               {"stride", header.stride},
               {"epoch", header.epoch},
               {"number", header.number},
               {"tick", header.tick},
               {"time", header.time},
               {"published", header.published},
               {"origin", frame.scale.grid.origin},
               {"quantum", frame.scale.grid.quantum},
               {"real_time_factor", header.real_time_factor},
               {"blocks", Json::array()}};
  for (const GridBlock& block : frame.blocks) {
    json["blocks"].push_back(block_to_json(frame, block, names));
  }
  return json;
}

}  // namespace vat::script
