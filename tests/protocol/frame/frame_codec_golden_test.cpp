#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "protocol/json/json_reader.h"
#include "tests/protocol/frame/frame_limit_cases.h"

namespace vat::frame_codec_golden_test {
namespace {

using namespace frame_cases;

/// Returns the first three values, and the accelerations if frames have them.
template <class T>
std::vector<T> told(const FrameScale& scale, const ByAttribute<T>& values) {
  return {values.begin(), scale.attribute_quanta[3] > 0 ? values.end() : values.end() - 1};
}

Json to_json(const GridFrame& frame, std::uint8_t stride) {
  const FrameHeader& header = frame.header;
  return {{"playing", header.playing},
          {"slow", header.slow},
          {"detail", frame.detail},
          {"region", frame.has_region},
          {"stride", stride},
          {"epoch", header.epoch},
          {"number", header.number},
          {"tick", header.tick},
          {"time", header.time},
          {"published", header.published},
          {"origin", frame.scale.grid.origin},
          {"quantum", frame.scale.grid.quantum},
          {"attribute_quanta", told(frame.scale, frame.scale.attribute_quanta)},
          {"real_time_factor", header.real_time_factor}};
}

Json to_json(const FrameScale& scale, const GridBlock& block) {
  constexpr std::array kKinds{"liquid", "deformable", "rigid", "vat"};
  Json json = {{"body", block.body}, {"kind", kKinds.at(static_cast<std::size_t>(block.kind))}};
  if (!block.has_particles()) {
    json["place"] = block.place;
    if (block.kind == GridBlock::Kind::vat) return json;
    json["orientation"] = block.orientation;
    json["orientation_bits"] = block.orientation_bits;
    return json;
  }
  std::vector<std::uint32_t> numbers;
  for (std::size_t i = 0; i < block.particle_count(); ++i) numbers.push_back(block.number(i));
  json["numbers"] = numbers;
  json["grid_positions"] = block.positions;
  json["attributes"] = told(scale, block.attributes);
  return json;
}

Json blocks_to_json(const GridFrame& frame) {
  Json blocks = Json::array();
  for (const GridBlock& block : frame.blocks) blocks.push_back(to_json(frame.scale, block));
  return blocks;
}

/// Returns the expected output of a decoder, and the frames that it must decode before.
Json description_of(const Stream& stream, std::size_t index) {
  Json before = Json::array();
  for (std::size_t i = 0; i < index; ++i) before.push_back(stream[i].name);
  const Step& step = stream[index];
  return {{"after", before},
          {"header", to_json(step.frame, step.stride)},
          {"blocks", blocks_to_json(step.frame)}};
}

bool update_wanted() {
  return std::getenv("VAT_UPDATE_GOLDEN") != nullptr;  // NOLINT(concurrency-mt-unsafe)
}

void update(const Stream& stream, std::size_t index) {
  const std::string& name = stream[index].name;
  std::ofstream binary(golden_path(name + ".bin"), std::ios::binary);
  for (const std::uint8_t byte : encode(stream, index)) binary.put(static_cast<char>(byte));
  std::ofstream text(golden_path(name + ".json"));
  text << description_of(stream, index).dump() << '\n';
  ASSERT_TRUE(binary.good() && text.good());
}

std::vector<std::uint8_t> golden_bytes(const std::string& name) {
  return read_bytes(golden_path(name + ".bin"));
}

TEST(GoldenFrames, AreEncodedByteForByte) {
  for (const Stream& stream : all_streams()) {
    for (std::size_t i = 0; i < stream.size(); ++i) {
      if (update_wanted()) update(stream, i);
      EXPECT_EQ(encode(stream, i), golden_bytes(stream[i].name)) << stream[i].name;
    }
  }
}

TEST(GoldenFrames, DecodeToTheirDescriptions) {
  for (const Stream& stream : all_streams()) {
    FrameDecoder decoder;
    for (std::size_t i = 0; i < stream.size(); ++i) {
      const auto frame = decoder.decode(golden_bytes(stream[i].name));
      ASSERT_TRUE(frame.ok()) << stream[i].name << frame.errors().front().code;
      const Json expected = Json::parse(read_text(golden_path(stream[i].name + ".json")));
      EXPECT_EQ(to_json(*frame.value(), frame.value()->header.stride), expected.at("header"));
      EXPECT_EQ(blocks_to_json(*frame.value()), expected.at("blocks")) << stream[i].name;
      EXPECT_EQ(description_of(stream, i), expected) << stream[i].name;
    }
  }
}

std::vector<std::uint8_t> from_hex(const std::string& hex) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(hex.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

/// Returns a valid frame with the damage of an entry of bad.json.
std::vector<std::uint8_t> damaged(const Json& entry) {
  std::vector<std::uint8_t> bytes = golden_bytes(entry.at("base").get<std::string>());
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
  std::set<std::string> codes;
  for (const Json& entry : list) {
    FrameDecoder decoder;
    for (const Json& before : entry.at("after")) {
      ASSERT_TRUE(decoder.decode(golden_bytes(before.get<std::string>())).ok());
    }
    const auto frame = decoder.decode(damaged(entry));
    ASSERT_FALSE(frame.ok()) << entry.at("name");
    EXPECT_EQ(frame.errors().front().code, entry.at("error").get<std::string>())
        << entry.at("name");
    codes.insert(frame.errors().front().code);
  }
  EXPECT_EQ(codes, (std::set<std::string>{"bad_magic", "bad_version", "bad_type", "bad_header",
                                          "bad_block", "bad_check", "missing_reference",
                                          "truncated", "extra_bytes"}));
}

}  // namespace
}  // namespace vat::frame_codec_golden_test
