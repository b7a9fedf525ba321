#pragma once

#include <span>

#include "tests/protocol/frame/frame_codec_cases.h"

/// Streams at the limits of PROTOCOL.md, "Frames". A decoder with any limit off by one gives a
/// different result.
namespace vat::frame_cases {

inline constexpr std::int32_t kLastPlace = 1 << 28;
inline constexpr std::int32_t kLastAttribute = 1 << 20;

/// A frame without blocks, a thirtieth of a second after the previous one.
inline GridFrame empty_frame(std::uint32_t number, const FrameScale& scale = plain_scale()) {
  GridFrame frame;
  frame.header.epoch = 4;
  frame.header.number = number;
  frame.header.tick = number;
  frame.header.time = number / 30.0;
  frame.scale = scale;
  return frame;
}
inline GridFrame frame_of(std::uint32_t number, std::vector<std::uint16_t> positions) {
  GridFrame frame = empty_frame(number);
  GridBlock& liquid = frame.blocks.emplace_back();
  liquid.body = 1;
  liquid.positions = std::move(positions);
  return frame;
}

/// A cell with more particles than are counted: 96 in one position, of which the first 63 came from
/// elsewhere. Then some of both groups disappear, and all others continue their motion.
inline Stream crowded_stream() {
  constexpr int kParticles = 96;
  constexpr int kCounted = 63;
  Chance chance(3);
  const auto within = [&](int least, int most) {
    return static_cast<std::uint16_t>(least + static_cast<int>((most - least) * chance.next()));
  };
  std::vector<std::uint16_t> apart;
  std::vector<std::uint16_t> near;
  std::vector<std::uint32_t> numbers;
  for (int i = 0; i < kParticles; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      apart.push_back(i < kCounted ? within(1000, 1200) : within(1100, 1400));
    }
    if (i % 8 == 5) continue;
    for (int axis = 0; axis < 3; ++axis) near.push_back(within(1280, 1320));
    numbers.push_back(static_cast<std::uint32_t>(i));
  }
  const std::vector<std::uint16_t> together(3 * kParticles, 1200);
  Stream stream{{"v2-crowded", frame_of(1, apart), {}, {}},
                {"v2-crowded-one", frame_of(2, together), 0, {}},
                {"v2-crowded-two", frame_of(3, near), 1, 0}};
  stream.back().frame.blocks[0].numbers = numbers;
  return stream;
}

/// Steps, residuals, sizes and attributes beyond the ranges of sums. Half of the particles drift by
/// 9000 steps per frame, and the others are random and include the grid's corners.
inline Stream wild_stream() {
  constexpr int kParticles = 48;
  constexpr int kDrift = 9000;
  // With these seeds, the maximum sizes determine classes, which is rare.
  constexpr std::array<std::uint32_t, 3> kSeeds{1281, 19, 20};
  FrameScale scale = plain_scale();
  scale.attribute_quanta = {1, 1, 1};
  Stream stream;
  for (std::uint32_t f = 0; f < 3; ++f) {
    Chance chance(kSeeds.at(f));
    GridFrame frame = empty_frame(f + 1, scale);
    GridBlock& liquid = frame.blocks.emplace_back();
    liquid.body = 1;
    for (int i = 0; i < kParticles; ++i) {
      const bool drifts = i % 2 == 0;
      const int drift = kDrift * static_cast<int>(f);
      for (int axis = 0; axis < 3; ++axis) {
        int place = static_cast<int>(65536 * chance.next());
        if (drifts) place = axis == 1 ? 60'000 - 40 * i - drift : 3000 + 40 * i + drift;
        if (i == 1) place = f % 2 == 0 ? 0 : 65535;
        if (i == 3) place = 65535;
        liquid.positions.push_back(static_cast<std::uint16_t>(place));
      }
      for (auto& column : std::span(liquid.attributes).first(3)) {
        column.push_back(static_cast<std::int32_t>((2 * chance.next() - 1) * kLastAttribute));
        if (i == 5) column.back() = f % 2 == 0 ? kLastAttribute : -kLastAttribute;
      }
    }
    stream.push_back(
        {std::array{"v2-wild", "v2-wild-one", "v2-wild-two"}.at(f), std::move(frame), {}, {}});
  }
  stream[1].first = 0;
  stream[2].first = 1;
  stream[2].second = 0;
  return stream;
}

/// Poses beyond, at or just before the maximum positions.
inline GridFrame pose_frame(std::uint32_t number, std::int32_t left) {
  GridFrame frame = empty_frame(number);
  GridBlock& vat = frame.blocks.emplace_back();
  vat.kind = GridBlock::Kind::vat;
  vat.place = {kLastPlace - left, -kLastPlace + left, left};
  GridBlock& stone = frame.blocks.emplace_back();
  stone.body = 1;
  stone.kind = GridBlock::Kind::rigid;
  stone.place = {-kLastPlace + left, left, kLastPlace - left};
  stone.orientation = {kLastPlace - left, left, 0, 0};
  stone.orientation_bits = 28;
  return frame;
}
inline Stream pose_stream() {
  Stream stream{{"v2-poses", pose_frame(1, 2000), {}, {}},
                {"v2-poses-one", pose_frame(2, 100), 0, {}},
                {"v2-poses-two", pose_frame(3, 0), 1, 0}};
  stream.back().frame.blocks[1].place[2] -= 3;
  return stream;
}

/// Two frames with one number. The next frame refers to the newer one.
inline Stream twice_stream() {
  const std::vector<std::uint16_t> before{100, 200, 300, 5000, 6000, 7000};
  const std::vector<std::uint16_t> one{101, 201, 301, 5001, 6001, 7001};
  const std::vector<std::uint16_t> again{101, 201, 301, 5002, 6001, 7001};
  const std::vector<std::uint16_t> next{102, 202, 302, 5002, 6002, 7002};
  return {{"v2-twice", frame_of(10, before), {}, {}},
          {"v2-twice-one", frame_of(12, one), 0, {}},
          {"v2-twice-again", frame_of(12, again), 0, {}},
          {"v2-twice-next", frame_of(13, next), 2, {}}};
}

/// 49 particles at one position, and one further along x.
inline std::vector<std::uint16_t> line(std::uint16_t apart, std::uint16_t from) {
  std::vector<std::uint16_t> positions(std::size_t{3} * 50, from);
  positions[std::size_t{3} * 49] = static_cast<std::uint16_t>(from + apart);
  return positions;
}
/// The largest distance: with 541 steps between them, cells of a step are 3 * 3 * 544 = 4096 + 16 *
/// 50.
inline constexpr std::uint16_t kLongestLine = 541;
inline Stream box_stream() {
  return {{"v2-box", frame_of(1, line(kLongestLine, 7)), {}, {}},
          {"v2-box-one", frame_of(2, line(kLongestLine, 8)), 0, {}}};
}
inline Stream wider_box_stream() {
  return {{"v2-wider-box", frame_of(1, line(kLongestLine + 1, 7)), {}, {}},
          {"v2-wider-box-one", frame_of(2, line(kLongestLine + 1, 8)), 0, {}}};
}

/// One particle at the grid's corners, with maximum attributes.
inline Stream corner_stream() {
  FrameScale scale = plain_scale();
  scale.attribute_quanta = {1, 1, 1};
  Stream stream{{"v2-corner", frame_of(1, {65534, 1, 65535}), {}, {}},
                {"v2-corner-one", frame_of(2, {65535, 0, 0}), 0, {}}};
  for (Step& step : stream) step.frame.scale = scale;
  stream[0].frame.blocks[0].attributes = {{{kLastAttribute}, {-kLastAttribute}, {0}, {}}};
  stream[1].frame.blocks[0].attributes = {{{-kLastAttribute}, {kLastAttribute}, {0}, {}}};
  return stream;
}

inline std::vector<Stream> limit_streams() {
  return {crowded_stream(), wild_stream(),      pose_stream(),  twice_stream(),
          box_stream(),     wider_box_stream(), corner_stream()};
}

inline std::vector<Stream> all_streams() {
  std::vector<Stream> streams{edge_stream(), moving_stream(),
                              attribute_stream("attributes", scale_with_attributes()),
                              attribute_stream("accelerations", scale_with_accelerations())};
  for (Stream& stream : limit_streams()) streams.push_back(std::move(stream));
  return streams;
}

}  // namespace vat::frame_cases
