#include "tests/bench/codec/many.h"

#include <array>
#include <stdexcept>

#include "protocol/frame/frame_codec.h"
#include "protocol/frame/frame_domain.h"
#include "tests/bench/codec/stopwatch.h"
#include "tests/bench/codec/stream.h"
#include "tests/bench/report/quantile.h"

namespace vat::bench {
namespace {

/// Runs a function, and adds its time [s] to `times`.
template <class Function>
void time(std::vector<Real>& times, const Function& function) {
  const Stopwatch stopwatch;
  function();
  times.push_back(stopwatch.seconds());
}

ManyResult measure_level(const Recording& recording, const FrameScale& scale, std::uint8_t detail) {
  std::vector<Real> quantise;
  std::vector<Real> encode;
  std::vector<Real> decode;
  FrameEncoder encoder;
  FrameDecoder decoder;
  std::array<GridFrame, 3> sent;  // the present frame is f % 3
  ManyResult result;
  for (std::size_t f = 0; f < recording.states.size(); ++f) {
    GridFrame& frame = sent[f % 3];
    time(quantise, [&] { make_grid_frame(recording.states[f], scale, detail, frame); });
    FrameReferences references;
    if (f > 0) references.first = &sent[(f - 1) % 3];
    if (f > 1) references.second = &sent[(f - 2) % 3];
    std::span<const std::uint8_t> bytes;
    time(encode, [&] { bytes = encoder.encode(frame, references); });
    const GridFrame* decoded = nullptr;
    time(decode, [&] {
      const auto frame_of_bytes = decoder.decode(bytes);
      if (frame_of_bytes) decoded = frame_of_bytes.value();
    });
    if (decoded == nullptr || !show_the_same(*decoded, frame)) {
      throw std::runtime_error("a decoder has other integers than the encoder");
    }
    result.bytes = static_cast<Real>(bytes.size());
    result.particles = 0;
    for (const GridBlock& block : frame.blocks) result.particles += block.particle_count();
  }
  result.detail = detail;
  result.quantise = median(quantise);
  result.encode = median(encode);
  result.decode = median(decode);
  return result;
}

}  // namespace

std::vector<ManyResult> measure_many(const Recording& recording, Real max_error) {
  FrameDomain domain;
  for (const PublishedState& state : recording.states) domain.include(state);
  const FrameScale scale{domain.grid(max_error), {}};
  std::vector<ManyResult> results;
  for (std::uint8_t detail = 0; detail <= kFullDetail; ++detail) {
    results.push_back(measure_level(recording, scale, detail));
  }
  return results;
}

}  // namespace vat::bench
