#include <cmath>

#include "protocol/frame_codec.h"
#include "protocol/frame_layout.h"
#include "tests/fuzz/target.h"

namespace {

/// The bytes that the decoded frame stands for.
std::size_t size_of(const vat::Frame& frame) {
  using namespace vat;
  std::size_t size = frame_layout::kHeaderSize;
  for (const FrameBlock& block : frame.blocks) {
    size += frame_layout::kBlockHeaderSize;
    if (block.kind == FrameBlock::Kind::vat) {
      size += frame_layout::kOffsetSize;
    } else if (block.kind == FrameBlock::Kind::rigid) {
      size += frame_layout::kPoseSize;
    } else {
      size += block.grid_positions.size() * sizeof(std::uint16_t);
    }
  }
  return size;
}

}  // namespace

/// A frame's bytes. One that is taken has not a byte more or less than its blocks need, and finite
/// numbers only.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vat;
  const Result<Frame> frame = decode_frame({data, size});
  if (!frame) {
    VAT_CHECK(frame.errors().size() == 1);
    return 0;
  }
  VAT_CHECK(size_of(frame.value()) == size);
  VAT_CHECK(std::isfinite(frame.value().header.quantum) && frame.value().header.quantum > 0);
  for (const FrameBlock& block : frame.value().blocks) {
    for (const double coordinate : block.position) VAT_CHECK(std::isfinite(coordinate));
    for (const float component : block.orientation) VAT_CHECK(std::isfinite(component));
  }
  return 0;
}
