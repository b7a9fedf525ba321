#include "tests/bench/codec/decode_times.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <stdexcept>

#include "protocol/frame/frame_codec.h"
#include "tests/bench/report/csv_file.h"
#include "tests/bench/report/run_program.h"

namespace vat::bench {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWeb = VAT_SOURCE_DIR "/web";
constexpr int kRounds = 3;  // after one more
constexpr Real kDecodeMillisecond = 1e-3;

/// Reads rows of decoder, version, "delta" or "key", and a time [ms]. Rows of one decoder are
/// adjacent.
Result<std::vector<DecodeTimes>> read_times(const fs::path& file) {
  Result<CsvFile> csv = read_csv_file(file);
  if (!csv) return csv.errors();
  std::vector<DecodeTimes> all;
  for (const std::vector<std::string>& row : csv.value().rows) {
    if (row.size() != 4) return Error{"format", file.string(), "must have four columns"};
    if (all.empty() || all.back().decoder != row[0]) all.push_back({row[0], row[1], {}, {}});
    Real milliseconds = 0;
    const char* end = row[3].data() + row[3].size();
    const auto [rest, error] = std::from_chars(row[3].data(), end, milliseconds);
    if (error != std::errc{} || rest != end) {
      return Error{"format", file.string(), "\"" + row[3] + "\" is no time"};
    }
    auto& times = row[2] == "key" ? all.back().keys : all.back().deltas;
    times.push_back(kDecodeMillisecond * milliseconds);
  }
  return all;
}

}  // namespace

DecodeTimes time_decoder(const std::vector<FrameBytes>& stream) {
  using Clock = std::chrono::steady_clock;
  DecodeTimes times{"C++", {}, {}, {}};
  FrameDecoder decoder;
  for (int round = 0; round <= kRounds; ++round) {
    for (std::size_t f = 0; f < stream.size(); ++f) {
      const auto begin = Clock::now();
      const bool is_good = decoder.decode(stream[f]).ok();
      const Real seconds = std::chrono::duration<Real>(Clock::now() - begin).count();
      if (!is_good) throw std::runtime_error("a decoder refuses what was encoded");
      if (round == 0 || f == 1) continue;  // frame 1 has one reference, unlike all others
      (is_key_frame(stream[f]) ? times.keys : times.deltas).push_back(seconds);
    }
  }
  return times;
}

std::string no_web_decoder() {
  std::error_code error;
  if (fs::exists(fs::path(kWeb) / "node_modules" / ".bin" / "vite-node", error)) return "";
  return "web/node_modules is not there: `./vat prepare test` fetches it";
}

Result<std::vector<DecodeTimes>> time_web_decoder(const std::vector<FrameBytes>& stream,
                                                  const fs::path& folder, const std::string& name) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error{"system", folder.string(), error.message()};
  const fs::path frames = fs::absolute(folder) / (name + ".frames");
  const fs::path result = fs::absolute(folder) / (name + ".decode-times.csv");
  if (Status written = write_stream(stream, frames); !written) return written.errors();
  const Status run = run_program(
      {"npm", "--prefix", kWeb, "run", "bench:decode", "--", frames.string(), result.string()},
      folder, name + ".decode-times.log", "it comes with Node");
  if (!run) return run.errors();
  return read_times(result);
}

}  // namespace vat::bench
