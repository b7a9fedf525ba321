#include <algorithm>

#include "protocol/frame/frame_codec.h"
#include "tests/fuzz/target.h"

namespace {

/// Every accepted frame is one that an encoder accepts. Encoded again, alone and relative to the
/// previous frame, it is unchanged.
void check_round_trip(const vat::GridFrame& frame, const vat::GridFrame* before) {
  using namespace vat;
  const Result<GridFrame> again = decode_key_frame(encode_key_frame(frame));
  VAT_CHECK(again.ok() && show_the_same(again.value(), frame));
  if (before == nullptr || !can_refer(frame, *before)) return;
  FrameDecoder decoder;
  VAT_CHECK(decoder.decode(encode_key_frame(*before)).ok());
  FrameEncoder encoder;
  const auto decoded = decoder.decode(encoder.encode(frame, {before, nullptr}));
  VAT_CHECK(decoded.ok() && show_the_same(*decoded.value(), frame));
}

}  // namespace

/// The input contains frames, each preceded by two bytes with its length, or one frame.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vat;
  std::span<const std::uint8_t> left(data, size);
  const Result<GridFrame> alone = decode_key_frame(left);
  if (alone) check_round_trip(alone.value(), nullptr);
  FrameDecoder decoder;
  GridFrame before;
  bool has_before = false;
  while (left.size() > 2) {
    const std::size_t length = left[0] | static_cast<std::size_t>(left[1]) << 8;
    left = left.subspan(2);
    const auto bytes = left.first(std::min(length, left.size()));
    left = left.subspan(bytes.size());
    const Result<const GridFrame*> frame = decoder.decode(bytes);
    if (!frame) {
      VAT_CHECK(frame.errors().size() == 1);
      continue;
    }
    check_round_trip(*frame.value(), has_before ? &before : nullptr);
    before = *frame.value();
    has_before = true;
  }
  return 0;
}
