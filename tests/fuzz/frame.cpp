#include <cmath>

#include "protocol/frame_codec.h"
#include "tests/fuzz/target.h"

/// A frame's bytes.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vat;
  const Result<GridFrame> frame = decode_key_frame({data, size});
  if (!frame) {
    VAT_CHECK(frame.errors().size() == 1);
    return 0;
  }
  VAT_CHECK(std::isfinite(frame.value().scale.grid.quantum));
  const std::vector<std::uint8_t> again = encode_key_frame(frame.value());
  VAT_CHECK(std::equal(again.begin(), again.end(), data, data + size));
  return 0;
}
