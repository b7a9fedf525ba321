#include "tests/protocol/frame_json.h"

#include "protocol/frame_codec.h"

namespace vat::script {
namespace {

Json block_to_json(const FrameBlock& block) {
  constexpr std::array kKinds{"liquid", "deformable", "rigid", "vat"};
  Json json = {{"body", block.body}, {"kind", kKinds.at(static_cast<std::size_t>(block.kind))}};
  switch (block.kind) {
    case FrameBlock::Kind::rigid:
      json["orientation"] = block.orientation;
      [[fallthrough]];
    case FrameBlock::Kind::vat:
      json["position"] = block.position;
      break;
    default:
      json["grid_positions"] = block.grid_positions;
  }
  return json;
}

}  // namespace

Json frame_to_json(const std::string& bytes) {
  const std::vector<std::uint8_t> data(bytes.begin(), bytes.end());
  const Result<Frame> frame = decode_frame(data);
  if (!frame) {
    throw std::runtime_error("a bad frame came: " + frame.errors().front().code + ": " +
                             frame.errors().front().message);
  }
  const FrameHeader& header = frame.value().header;
  Json json = {{"bytes", bytes.size()},       {"playing", header.playing},
               {"slow", header.slow},         {"epoch", header.epoch},
               {"sequence", header.sequence}, {"tick", header.tick},
               {"time", header.time},         {"published", header.published},
               {"dropped", header.dropped},   {"origin", header.origin},
               {"quantum", header.quantum},   {"real_time_factor", header.real_time_factor},
               {"blocks", Json::array()}};
  for (const FrameBlock& block : frame.value().blocks)
    json["blocks"].push_back(block_to_json(block));
  return json;
}

}  // namespace vat::script
