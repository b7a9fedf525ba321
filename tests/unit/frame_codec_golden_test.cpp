#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/unit/frame_codec_cases.h"

namespace vat {
namespace {

using namespace frame_cases;

/// What a decoder must give, as the golden files say it.
Json to_json(const FrameHeader& header) {
  return {{"playing", header.playing},
          {"slow", header.slow},
          {"epoch", header.epoch},
          {"sequence", header.sequence},
          {"tick", header.tick},
          {"time", header.time},
          {"published", header.published},
          {"dropped", header.dropped},
          {"origin", header.origin},
          {"quantum", header.quantum},
          {"real_time_factor", header.real_time_factor}};
}

Json to_json(const FrameBlock& block) {
  constexpr std::array kKinds{"liquid", "deformable", "rigid", "vat"};
  Json json = {{"body", block.body}, {"kind", kKinds.at(static_cast<std::size_t>(block.kind))}};
  if (block.kind == FrameBlock::Kind::rigid) json["orientation"] = block.orientation;
  if (block.kind == FrameBlock::Kind::rigid || block.kind == FrameBlock::Kind::vat) {
    json["position"] = block.position;
  } else {
    json["grid_positions"] = block.grid_positions;
  }
  return json;
}

Json to_json(const Frame& frame) {
  Json blocks = Json::array();
  for (const FrameBlock& block : frame.blocks) blocks.push_back(to_json(block));
  return {{"header", to_json(frame.header)}, {"blocks", blocks}};
}

/// The frame that a case stands for, worked out without the codec.
Frame expected_frame(const FrameCase& frame) {
  Frame result{frame.state.header, {}};
  result.header.sequence = frame.sequence;
  result.header.dropped = frame.dropped;
  result.header.origin = frame.grid.origin;
  result.header.quantum = frame.grid.quantum;
  if (frame.state.has_vat) {
    const Vec3& offset = frame.state.vat_offset;
    result.blocks.push_back(
        {0, FrameBlock::Kind::vat, {}, {offset.x(), offset.y(), offset.z()}, {1, 0, 0, 0}});
  }
  for (const PublishedState::Body& body : frame.state.bodies) {
    FrameBlock block{body.id,
                     static_cast<FrameBlock::Kind>(body.kind),
                     {},
                     body.center_of_mass,
                     body.orientation};
    for (const Vec3& position : body.positions) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double from_origin =
            position[static_cast<Eigen::Index>(axis)] - frame.grid.origin[axis];
        const long step = std::lround(from_origin / frame.grid.quantum);
        block.grid_positions.push_back(static_cast<std::uint16_t>(std::clamp(step, 0L, 65535L)));
      }
    }
    result.blocks.push_back(std::move(block));
  }
  return result;
}

bool update_wanted() {
  const char* value = std::getenv("VAT_UPDATE_GOLDEN");
  return value != nullptr && std::string(value) == "1";
}

void update(const FrameCase& frame) {
  const std::vector<std::uint8_t> bytes = encode(frame);
  std::ofstream binary(golden_path(frame.name + ".bin"), std::ios::binary);
  for (const std::uint8_t byte : bytes) binary.put(static_cast<char>(byte));
  std::ofstream text(golden_path(frame.name + ".json"));
  text << to_json(expected_frame(frame)).dump(1) << '\n';
  ASSERT_TRUE(binary.good() && text.good());
}

class GoldenFrame : public testing::TestWithParam<FrameCase> {
 protected:
  void SetUp() override {
    if (update_wanted()) update(GetParam());
  }
};

TEST_P(GoldenFrame, IsEncodedByteForByte) {
  EXPECT_EQ(encode(GetParam()), read_bytes(golden_path(GetParam().name + ".bin")));
}

TEST_P(GoldenFrame, DecodesToItsDescription) {
  const Result<Frame> frame = decode_frame(read_bytes(golden_path(GetParam().name + ".bin")));
  ASSERT_TRUE(frame.ok());
  const Json expected = Json::parse(read_text(golden_path(GetParam().name + ".json")));
  EXPECT_EQ(to_json(frame.value()), expected);
  EXPECT_EQ(to_json(expected_frame(GetParam())), expected);
}

INSTANTIATE_TEST_SUITE_P(All, GoldenFrame, testing::ValuesIn(all_cases()), [](const auto& frame) {
  return frame.param.name.substr(std::string("v1-").size());
});

std::vector<std::uint8_t> from_hex(const std::string& hex) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(hex.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

/// A good frame with the damage that an entry of bad.json describes.
std::vector<std::uint8_t> damaged(const Json& entry) {
  std::vector<std::uint8_t> bytes = read_bytes(golden_path(entry.at("base").get<std::string>()));
  if (entry.contains("keep")) bytes.resize(entry.at("keep").get<std::size_t>());
  if (entry.contains("append")) {
    for (const auto byte : from_hex(entry.at("append"))) bytes.push_back(byte);
  }
  if (entry.contains("patch")) {
    auto offset = entry.at("patch").at("offset").get<std::size_t>();
    for (const auto byte : from_hex(entry.at("patch").at("bytes"))) bytes.at(offset++) = byte;
  }
  return bytes;
}

TEST(BadFrames, AreRefusedWithTheNamedError) {
  const Json list = Json::parse(read_text(golden_path("bad.json")));
  ASSERT_GE(list.size(), 30U);
  for (const Json& entry : list) {
    const std::vector<std::uint8_t> bytes = damaged(entry);
    ASSERT_NE(bytes, read_bytes(golden_path(entry.at("base").get<std::string>())))
        << entry.at("name");
    const Result<Frame> frame = decode_frame(bytes);
    ASSERT_FALSE(frame.ok()) << entry.at("name");
    EXPECT_EQ(frame.errors().front().code, entry.at("error").get<std::string>())
        << entry.at("name");
  }
}

}  // namespace
}  // namespace vat
