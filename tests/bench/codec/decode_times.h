#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "core/types.h"
#include "tests/bench/codec/stream.h"

namespace vat::bench {

/// How long a decoder took for frames with two references, and for key frames [s].
struct DecodeTimes {
  std::string decoder;
  std::string version;  ///< of what it runs in; empty for C++
  std::vector<Real> deltas;
  std::vector<Real> keys;
};

/// Of the decoder in C++, once it has seen the stream before. Throws std::runtime_error where it
/// refuses a frame.
DecodeTimes time_decoder(const std::vector<FrameBytes>& stream);

/// Why the decoder in TypeScript cannot be timed; empty if it can.
std::string no_web_decoder();

/// The same of the decoder in TypeScript, in Node and, if there is one, in a worker of Chromium.
/// Leaves the stream in the folder, as NAME.frames. Fails where programs of web/ do.
Result<std::vector<DecodeTimes>> time_web_decoder(const std::vector<FrameBytes>& stream,
                                                  const std::filesystem::path& folder,
                                                  const std::string& name);

}  // namespace vat::bench
