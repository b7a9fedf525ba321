#include "tests/protocol/frame_json.h"

namespace vat::script {
namespace {

Json block_to_json(const GridFrame& frame, const GridBlock& block) {
  constexpr std::array kKinds{"liquid", "deformable", "rigid", "vat"};
  Json json = {{"body", block.body}, {"kind", kKinds.at(static_cast<std::size_t>(block.kind))}};
  if (block.has_particles()) {
    json["grid_positions"] = block.positions;
    return json;
  }
  json["position"] = place_of(frame, block);
  if (block.kind == GridBlock::Kind::rigid) json["orientation"] = orientation_of(block);
  return json;
}

}  // namespace

Json frame_to_json(const std::string& bytes, FrameDecoder& decoder) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  const Result<const GridFrame*> result = decoder.decode({data, bytes.size()});
  if (!result) {
    throw std::runtime_error("a bad frame came: " + result.errors().front().code + ": " +
                             result.errors().front().message);
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
    json["blocks"].push_back(block_to_json(frame, block));
  }
  return json;
}

}  // namespace vat::script
