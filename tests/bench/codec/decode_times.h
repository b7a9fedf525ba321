#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "core/types.h"
#include "tests/bench/codec/stream.h"

namespace vat::bench {

/// Decoding times of frames with two references and of key frames [s].
struct DecodeTimes {
  std::string decoder;
  std::string version;  ///< version of the runtime; empty for C++
  std::vector<Real> deltas;
  std::vector<Real> keys;
};

/// Returns the times of the C++ decoder after a first pass over the stream. Throws
/// std::runtime_error if it rejects a frame.
DecodeTimes time_decoder(const std::vector<FrameBytes>& stream);

/// Returns the reason why the TypeScript decoder cannot be timed; empty if it can.
std::string no_web_decoder();

/// Returns the times of the TypeScript decoder in Node and, if there is one, in a worker of
/// Chromium. Writes the stream to NAME.frames in the folder. Fails if a program of web/ fails.
Result<std::vector<DecodeTimes>> time_web_decoder(const std::vector<FrameBytes>& stream,
                                                  const std::filesystem::path& folder,
                                                  const std::string& name);

}  // namespace vat::bench
