#include "tests/bench/codec/stream.h"

#include <string>

#include "core/support/byte_io.h"
#include "protocol/frame/frame_codec.h"
#include "tests/bench/report/table.h"

namespace vat::bench {
namespace {

FrameBytes encoded(FrameEncoder& encoder, const GridFrame& frame, const FrameReferences& on) {
  const auto bytes = encoder.encode(frame, on);
  return {bytes.begin(), bytes.end()};
}

}  // namespace

std::vector<FrameBytes> stream_of(const std::vector<GridFrame>& frames) {
  FrameEncoder encoder;
  std::vector<FrameBytes> stream;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    FrameReferences references;
    if (f > 0) references.first = &frames[f - 1];
    if (f > 1) references.second = &frames[f - 2];
    stream.push_back(encoded(encoder, frames[f], references));
  }
  for (std::size_t f = kKeyInterval / 2; f < frames.size(); f += kKeyInterval) {
    stream.push_back(encoded(encoder, frames[f], {}));
  }
  return stream;
}

Status write_stream(const std::vector<FrameBytes>& stream, const std::filesystem::path& file) {
  std::vector<std::uint8_t> bytes;
  for (const FrameBytes& frame : stream) {
    ByteWriter(bytes).put(static_cast<std::uint32_t>(frame.size()));
    bytes.insert(bytes.end(), frame.begin(), frame.end());
  }
  return write_text(file, {bytes.begin(), bytes.end()});
}

}  // namespace vat::bench
