#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <set>

#include "protocol/frame/rans.h"
#include "tests/protocol/frame/frame_limit_cases.h"
#include "tests/support/memory/allocation_counter.h"

namespace vat::frame_codec_test {
namespace {

using namespace frame_cases;

template <class T>
std::string code_of(const Result<T>& frame) {
  return frame.ok() ? "" : frame.errors().front().code;
}

/// Returns a decoder that has decoded the first frames of a stream.
FrameDecoder decoder_after(const Stream& stream, std::size_t count) {
  FrameDecoder decoder;
  for (std::size_t i = 0; i < count; ++i) EXPECT_TRUE(decoder.decode(encode(stream, i)).ok());
  return decoder;
}

TEST(Rans, DecodesTheEncodedSymbols) {
  std::mt19937 random(5);
  struct Symbol {
    std::uint32_t lane, start, frequency;
  };
  std::vector<Symbol> symbols;
  rans::Encoder encoder;
  for (int i = 0; i < 20'000; ++i) {
    const auto start = static_cast<std::uint32_t>(random() % rans::kScale);
    const auto frequency = static_cast<std::uint32_t>(1 + random() % (rans::kScale - start));
    symbols.push_back({static_cast<std::uint32_t>(random() % rans::kLanes), start, frequency});
    encoder.put(symbols.back().lane, start, frequency);
  }
  std::vector<std::uint8_t> bytes;
  encoder.finish(bytes);
  rans::Decoder decoder(bytes);
  ASSERT_TRUE(decoder.states_are_valid());
  double bits = 0;
  for (const auto& [lane, start, frequency] : symbols) {
    const std::uint32_t slot = decoder.slot(lane);
    ASSERT_TRUE(slot >= start && slot < start + frequency);
    decoder.take(lane, start, frequency);
    bits += 12 - std::log2(frequency);
  }
  EXPECT_TRUE(decoder.is_at_start());
  EXPECT_EQ(decoder.bytes_left(), 0U);
  EXPECT_FALSE(decoder.ended_early());
  // States hold at most 31 bits, and a partial word remains. 0.1 % accounts for integer
  // frequencies.
  EXPECT_NEAR(8.0 * static_cast<double>(bytes.size()), bits, 3 * 31 + bits / 1000);
}

TEST(FrameCodec, EveryPrefixIsTruncated) {
  for (const Stream& stream : all_streams()) {
    for (std::size_t i = 0; i < stream.size(); ++i) {
      FrameDecoder decoder = decoder_after(stream, i);
      const std::vector<std::uint8_t> bytes = encode(stream, i);
      for (std::size_t size = 0; size < bytes.size(); ++size) {
        ASSERT_EQ(code_of(decoder.decode(std::span(bytes).first(size))), "truncated")
            << stream[i].name << " cut to " << size;
      }
      EXPECT_TRUE(decoder.decode(bytes).ok()) << "a rejected frame must not change the decoder";
    }
  }
}

// A flipped bit of the header may change the meaning. A flipped bit of the blocks may only select
// another encoding of the same values, such as the strides of three particles.
TEST(FrameCodec, NoFlippedBitOfTheBlocksChangesThem) {
  const std::set<std::string> codes{"bad_block", "bad_check", "truncated", "extra_bytes"};
  for (const Stream& stream : all_streams()) {
    for (std::size_t i = 0; i < stream.size(); ++i) {
      const std::vector<std::uint8_t> good = encode(stream, i);
      const std::size_t key_header = stream[i].frame.scale.attribute_quanta[3] > 0 ? 116 : 108;
      const std::size_t header = is_key_frame(good) ? key_header : 52;
      for (std::size_t bit = 8 * header; bit < 8 * good.size(); ++bit) {
        std::vector<std::uint8_t> bytes = good;
        bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1U << (bit % 8)));
        FrameDecoder decoder = decoder_after(stream, i);
        const auto decoded = decoder.decode(bytes);
        if (decoded) {
          ASSERT_EQ(decoded.value()->blocks, stream[i].frame.blocks) << stream[i].name;
        } else {
          ASSERT_EQ(codes.count(code_of(decoded)), 1U) << stream[i].name << " bit " << bit;
        }
      }
    }
  }
}

TEST(FrameCodec, ReferencesAreEarlierFramesOfOneScaleAndEpoch) {
  World world;
  const GridFrame early = on_grid(world.state(), plain_scale());
  world.advance(1);
  const GridFrame late = on_grid(world.state(), plain_scale());
  EXPECT_TRUE(can_refer(late, early));
  EXPECT_FALSE(can_refer(early, late));
  EXPECT_FALSE(can_refer(late, late));
  GridFrame other = early;
  other.header.epoch = 3;
  EXPECT_FALSE(can_refer(late, other));
  EXPECT_FALSE(can_refer(late, on_grid(World().state(), plain_scale(2e-3))));
  other = late;
  other.header.number = early.header.number + kMaxReferenceDistance;
  EXPECT_TRUE(can_refer(other, early));
  ++other.header.number;
  EXPECT_FALSE(can_refer(other, early));
}

/// One client of a random walk: the received frames and its decoder.
struct Viewer {
  std::deque<GridFrame> got;
  FrameDecoder decoder;
  FrameSelection selection;
};

class Walk : public testing::TestWithParam<int> {
 protected:
  double chance() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  std::size_t below(std::size_t end) { return random_() % end; }

  /// Returns any two frames of the ring, the newest first; or none.
  FrameReferences any_references(const Viewer& viewer) {
    FrameReferences references;
    if (viewer.got.empty() || chance() < 0.02) return references;
    const std::size_t first = chance() < 0.8 ? 0 : below(viewer.got.size());
    references.first = &viewer.got[first];
    const std::size_t left = viewer.got.size() - first - 1;
    if (left > 0 && chance() < 0.9) references.second = &viewer.got[first + 1 + below(left)];
    return references;
  }
  void change_selection(Viewer& viewer) {
    viewer.selection.detail = static_cast<std::uint8_t>(below(4));
    viewer.selection.region.reset();
    if (chance() < 0.5) return;
    const Vec3 corner(chance(), chance(), chance());
    viewer.selection.region = FrameRegion{corner - Vec3::Constant(0.4), corner + Vec3(1, 1, 1)};
  }
  void show(const GridFrame& all, Viewer& viewer) {
    GridFrame frame = part_of(all, viewer.selection);
    FrameReferences references = any_references(viewer);
    if (references.first != nullptr && !can_refer(frame, *references.first)) references = {};
    const auto stride = static_cast<std::uint8_t>(1 + below(4));
    const auto decoded = viewer.decoder.decode(encoder_.encode(frame, references, stride));
    ASSERT_TRUE(decoded.ok()) << decoded.errors().front().code;
    ASSERT_TRUE(show_the_same(*decoded.value(), frame));
    EXPECT_EQ(decoded.value()->header.stride, stride);
    EXPECT_EQ(decoded.value()->header.number, frame.header.number);
    if (references.first == nullptr) viewer.got.clear();
    viewer.got.push_front(std::move(frame));
    if (viewer.got.size() > kFrameRing) viewer.got.pop_back();
  }

  std::mt19937 random_{static_cast<std::uint32_t>(GetParam())};
  FrameEncoder encoder_;
};

// With dropped frames, late clients and different views, every path through the stream gives the
// server's integers.
TEST_P(Walk, EndsInTheServersIntegers) {
  World world(300, static_cast<std::uint32_t>(GetParam()));
  const FrameScale scale = GetParam() % 2 == 0 ? plain_scale() : scale_with_attributes();
  std::vector<Viewer> viewers(3);
  for (int round = 0; round < 120; ++round) {
    world.advance(1 + static_cast<int>(below(3)));
    if (chance() < 0.2) world.pour(static_cast<std::uint32_t>(below(20)));
    if (chance() < 0.1) world.drain(0.3 + 0.3 * chance());
    if (chance() < 0.05) viewers[below(3)] = Viewer{};
    if (chance() < 0.02) world.drain(100);
    const GridFrame all = on_grid(world.state(), scale);
    for (Viewer& viewer : viewers) {
      if (chance() < 0.3) continue;  // dropped
      if (chance() < 0.1) change_selection(viewer);
      show(all, viewer);
      if (HasFatalFailure()) return;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Walk, testing::Range(0, 8));

// Allocations end once every stored frame on both sides has the size that the stream needs.
TEST(FrameCodec, ASteadyStreamAllocatesNothing) {
  World world(500);
  std::array<GridFrame, 3> frames;
  for (GridFrame& frame : frames) {
    world.advance(1);
    frame = on_grid(world.state(), scale_with_attributes());
  }
  FrameEncoder encoder;
  FrameDecoder decoder;
  const auto send = [&](std::uint32_t number) {
    GridFrame& frame = frames[number % 3];
    frame.header.number = number;
    FrameReferences references;
    if (number > 1) references.first = &frames[(number - 1) % 3];
    if (number > 2) references.second = &frames[(number - 2) % 3];
    return decoder.decode(encoder.encode(frame, references)).ok();
  };
  for (std::uint32_t number = 1; number <= 60; ++number) ASSERT_TRUE(send(number));
  const std::size_t before = test::allocation_count();
  for (std::uint32_t number = 61; number <= 120; ++number) ASSERT_TRUE(send(number));
  EXPECT_EQ(test::allocation_count(), before);
}

}  // namespace
}  // namespace vat::frame_codec_test
