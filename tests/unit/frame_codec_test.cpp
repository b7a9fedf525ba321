#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "protocol/byte_io.h"
#include "tests/unit/frame_codec_cases.h"

namespace vat {
namespace {

using namespace frame_cases;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::string code_of(const Result<Frame>& frame) {
  return frame.ok() ? "" : frame.errors().front().code;
}

TEST(ByteIo, IsLittleEndian) {
  ByteWriter out(0);
  out.put(std::uint8_t{0x01});
  out.put(std::uint16_t{0x2345});
  out.put(std::uint32_t{0x6789abcd});
  out.put(1.0F);
  out.put(-2.0);
  const std::vector<std::uint8_t> bytes = out.take();
  EXPECT_EQ(bytes, (std::vector<std::uint8_t>{0x01, 0x45, 0x23, 0xcd, 0xab, 0x89, 0x67, 0, 0, 0x80,
                                              0x3f, 0, 0, 0, 0, 0, 0, 0, 0xc0}));
  ByteReader in(bytes);
  EXPECT_EQ(in.get<std::uint8_t>(), 0x01);
  EXPECT_EQ(in.get<std::uint16_t>(), 0x2345);
  EXPECT_EQ(in.get<std::uint32_t>(), 0x6789abcdU);
  EXPECT_EQ(in.get<float>(), 1.0F);
  EXPECT_EQ(in.get<double>(), -2.0);
  EXPECT_EQ(in.left(), 0U);
  EXPECT_FALSE(in.ended_early());
}

TEST(ByteIo, AReaderStaysAtTheEnd) {
  const std::vector<std::uint8_t> bytes{1, 2, 3};
  ByteReader in(bytes);
  EXPECT_EQ(in.get<std::uint32_t>(), 0U);
  EXPECT_TRUE(in.ended_early());
  EXPECT_EQ(in.get<std::uint8_t>(), 0U);
  EXPECT_EQ(in.left(), 0U);
}

TEST(FrameGrid, TakesTwiceTheErrorWhereTheDomainFits) {
  const FrameGrid grid = make_frame_grid({-1, 2, 0}, {3, 3, 1}, 1e-3);
  EXPECT_EQ(grid.quantum, 2e-3);
  EXPECT_EQ(grid.origin, (std::array<double, 3>{-1, 2, 0}));
}

TEST(FrameGrid, IsCoarserWhereTheDomainDoesNotFit) {
  for (const double max_error : {1e-9, 0.0, -1.0, std::nan(""), kInfinity}) {
    const FrameGrid grid = make_frame_grid({-1, 2, 0}, {3, 3, 1}, max_error);
    EXPECT_EQ(grid.quantum, 4.0 / 65535) << max_error;
  }
}

TEST(FrameGrid, OfAnEmptyDomainHasAQuantumAboveZero) {
  EXPECT_GT(make_frame_grid({1, 1, 1}, {1, 1, 1}, 0).quantum, 0);
  EXPECT_GT(make_frame_grid({1, 1, 1}, {0, 0, 0}, 0).quantum, 0);
}

/// Half a quantum, and the rounding of origin + quantum * integer in double precision.
double allowed_error(const FrameGrid& grid, const Vec3& min, const Vec3& max) {
  const double greatest = std::max(min.cwiseAbs().maxCoeff(), max.cwiseAbs().maxCoeff());
  return grid.quantum / 2 + 4 * std::numeric_limits<double>::epsilon() * greatest;
}

TEST(FrameCodec, PositionsComeBackWithinHalfAQuantum) {
  const std::vector<std::pair<Vec3, Vec3>> domains{{{0, 0, 0}, {1, 0.6, 0.6}},
                                                   {{-5, 3, -0.1}, {-4, 300, 0.1}},
                                                   {{-1e6, -1e6, -1e6}, {1e6, 1e6, 1e6}},
                                                   {{1e6 - 1e-3, 0, 0}, {1e6, 1e-3, 1e-3}}};
  std::mt19937 random(7);
  for (const auto& [min, max] : domains) {
    for (const double max_error : {0.0, 1e-4, 0.05}) {
      const FrameGrid grid = make_frame_grid(min, max, max_error);
      FrameCase frame = make_case("", {{1, BodyKind::liquid, {min, max}, {}, {1, 0, 0, 0}}});
      std::vector<Vec3>& positions = frame.state.bodies[0].positions;
      std::uniform_real_distribution<double> unit(0, 1);
      for (int i = 0; i < 500; ++i) {
        const Vec3 part(unit(random), unit(random), unit(random));
        positions.emplace_back(min + part.cwiseProduct(max - min));
      }
      const Result<Frame> decoded = decode_frame(encode_key_frame(frame.state, grid));
      ASSERT_TRUE(decoded.ok());
      const FrameHeader& header = decoded.value().header;
      const auto& coordinates = decoded.value().blocks.at(0).grid_positions;
      ASSERT_EQ(coordinates.size(), 3 * positions.size());
      for (std::size_t i = 0; i < coordinates.size(); ++i) {
        const double value = header.origin[i % 3] + header.quantum * coordinates[i];
        const double sent = positions[i / 3][static_cast<Eigen::Index>(i % 3)];
        ASSERT_LE(std::abs(value - sent), allowed_error(grid, min, max));
      }
    }
  }
}

TEST(FrameCodec, PositionsOutsideTheGridGoToItsEdge) {
  const double nan = std::nan("");
  FrameCase frame = make_case(
      "",
      {{1, BodyKind::liquid, {{-1, 5, nan}, {-kInfinity, kInfinity, 1e300}}, {}, {1, 0, 0, 0}}});
  const Result<Frame> decoded =
      decode_frame(encode_key_frame(frame.state, make_frame_grid({0, 0, 0}, {1, 1, 1}, 0)));
  ASSERT_TRUE(decoded.ok());
  EXPECT_EQ(decoded.value().blocks.at(0).grid_positions,
            (std::vector<std::uint16_t>{0, 65535, 0, 0, 65535, 65535}));
}

TEST(FrameCodec, PatchingAClientChangesItsTwoFieldsOnly) {
  const FrameCase frame = all_cases().at(5);
  std::vector<std::uint8_t> bytes = encode(frame);
  const Frame before = decode_frame(bytes).value();
  patch_client(bytes, 0x01020304, 0xfffefdfc);
  const Frame after = decode_frame(bytes).value();
  EXPECT_EQ(after.header.sequence, 0x01020304U);
  EXPECT_EQ(after.header.dropped, 0xfffefdfcU);
  patch_client(bytes, before.header.sequence, before.header.dropped);
  EXPECT_EQ(bytes, encode(frame));
}

TEST(FrameCodec, EveryPrefixIsTruncated) {
  for (const FrameCase& frame : all_cases()) {
    const std::vector<std::uint8_t> bytes = encode(frame);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_EQ(code_of(decode_frame(std::span(bytes).first(size))), "truncated")
          << frame.name << " cut to " << size;
    }
  }
}

TEST(FrameCodec, EveryExtraByteIsRefused) {
  for (const FrameCase& frame : all_cases()) {
    for (int byte = 0; byte < 256; ++byte) {
      std::vector<std::uint8_t> bytes = encode(frame);
      bytes.push_back(static_cast<std::uint8_t>(byte));
      EXPECT_EQ(code_of(decode_frame(bytes)), "extra_bytes") << frame.name;
    }
  }
}

/// A decoder loses nothing: what it gives, encoded again, is the frame.
std::vector<std::uint8_t> encode_again(const Frame& frame) {
  PublishedState state;
  state.header = frame.header;
  for (const FrameBlock& block : frame.blocks) {
    if (block.kind == FrameBlock::Kind::vat) {
      state.has_vat = true;
      state.vat_offset = {block.position[0], block.position[1], block.position[2]};
      continue;
    }
    PublishedState::Body body{
        block.body, static_cast<BodyKind>(block.kind), {}, block.position, block.orientation};
    const auto& grid = block.grid_positions;
    for (std::size_t i = 0; i < grid.size(); i += 3) {
      body.positions.emplace_back(grid[i], grid[i + 1], grid[i + 2]);
    }
    state.bodies.push_back(std::move(body));
  }
  // Grid coordinates were put in as positions: a grid of 1 m at the origin leaves them as they are.
  std::vector<std::uint8_t> bytes = encode_key_frame(state, {{0, 0, 0}, 1});
  ByteWriter grid(32);
  for (const double coordinate : frame.header.origin) grid.put(coordinate);
  grid.put(frame.header.quantum);
  const std::vector<std::uint8_t> grid_bytes = grid.take();
  std::copy(grid_bytes.begin(), grid_bytes.end(), bytes.begin() + 56);
  return bytes;
}

TEST(FrameCodec, EveryFlippedBitIsSeenOrRefused) {
  const std::set<std::string> codes{"bad_magic", "bad_version", "bad_type",   "bad_header",
                                    "bad_block", "truncated",   "extra_bytes"};
  for (const FrameCase& frame : all_cases()) {
    const std::vector<std::uint8_t> good = encode(frame);
    ASSERT_EQ(encode_again(decode_frame(good).value()), good) << frame.name;
    for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
      std::vector<std::uint8_t> bytes = good;
      bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1U << (bit % 8)));
      const Result<Frame> decoded = decode_frame(bytes);
      if (decoded) {
        EXPECT_EQ(encode_again(decoded.value()), bytes) << frame.name << " byte " << bit / 8;
      } else {
        EXPECT_EQ(codes.count(code_of(decoded)), 1U) << code_of(decoded);
      }
    }
  }
}

}  // namespace
}  // namespace vat
