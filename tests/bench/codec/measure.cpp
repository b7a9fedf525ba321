#include "tests/bench/codec/measure.h"

#include <algorithm>
#include <deque>
#include <random>
#include <stdexcept>
#include <utility>

#include "protocol/frame/frame_domain.h"
#include "tests/bench/codec/stopwatch.h"
#include "tests/bench/codec/stream.h"
#include "tests/bench/report/quantile.h"

namespace vat::bench {
namespace {

struct Samples {
  std::vector<Real> bytes;
  std::vector<Real> encode;
  std::vector<Real> decode;

  Real mean_bytes() const {
    Real sum = 0;
    for (const Real each : bytes) sum += each;
    return bytes.empty() ? 0 : sum / static_cast<Real>(bytes.size());
  }
};

void measure_one(const GridFrame& frame, const FrameReferences& references, FrameEncoder& encoder,
                 FrameDecoder& decoder, Samples& samples) {
  const Stopwatch encoding;
  const auto bytes = encoder.encode(frame, references);
  samples.encode.push_back(encoding.seconds());
  samples.bytes.push_back(static_cast<Real>(bytes.size()));
  const Stopwatch decoding;
  const auto decoded = decoder.decode(bytes);
  samples.decode.push_back(decoding.seconds());
  if (!decoded || !show_the_same(*decoded.value(), frame)) {
    throw std::runtime_error("a decoder has other integers than the encoder");
  }
}

Real error_of(const PublishedState& state, const GridFrame& frame) {
  Real worst = 0;
  const auto& [origin, quantum] = frame.scale.grid;
  const std::size_t vats = state.has_vat ? 1 : 0;
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    const GridBlock& block = frame.blocks[vats + b];
    for (std::size_t i = 0; i < state.bodies[b].positions.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Real sent = origin[axis] + quantum * block.positions[3 * i + axis];
        const Real off = sent - state.bodies[b].positions[i][static_cast<Eigen::Index>(axis)];
        worst = std::max(worst, std::abs(off) / (quantum / 2));
      }
    }
  }
  return worst;
}

/// Returns the particles of a frame. For rigid bodies, it is the number in the complete scene.
std::size_t shown(const GridFrame& frame) {
  std::size_t count = 0;
  for (const GridBlock& block : frame.blocks) count += block.particle_count();
  return count;
}

}  // namespace

std::vector<GridFrame> on_grids(const Recording& recording, Real max_error) {
  FrameDomain domain;
  for (const PublishedState& state : recording.states) domain.include(state);
  std::vector<GridFrame> frames(recording.states.size());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    make_grid_frame(recording.states[f], {domain.grid(max_error), {}}, frames[f]);
  }
  return frames;
}

CodecResult measure_codec(const Recording& recording, const std::vector<GridFrame>& frames,
                          const CodecSetting& setting) {
  std::mt19937 random(1);
  std::uniform_real_distribution<Real> chance(0, 1);
  FrameEncoder encoder;
  FrameDecoder decoder;
  Samples deltas;
  Samples keys;
  std::deque<GridFrame> sent;
  CodecResult result;
  Real missing = 0;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    result.worst_error = std::max(result.worst_error, error_of(recording.states[f], frames[f]));
    if (sent.size() >= 2 && chance(random) < setting.dropped) continue;
    GridFrame frame = frames[f];
    if (setting.detail < kFullDetail) select_particles(frames[f], {setting.detail, {}}, frame);
    missing += static_cast<Real>(shown(frames[f]) - shown(frame));
    FrameReferences references;
    if (!sent.empty()) references.first = &sent[0];
    if (sent.size() > 1) references.second = &sent[1];
    Samples warm_up;  // the stream starts with a frame without and one with one reference
    measure_one(frame, references, encoder, decoder, sent.size() < 2 ? warm_up : deltas);
    if (f % kKeyInterval == kKeyInterval / 2) {
      FrameDecoder alone;
      measure_one(frame, {}, encoder, alone, keys);
    }
    sent.push_front(std::move(frame));
    if (sent.size() > 2) sent.pop_back();
  }
  result.delta_frames = deltas.bytes.size();
  const auto count = static_cast<Real>(result.delta_frames + 2);
  result.particles = recording.particles - static_cast<std::size_t>(missing / count);
  result.delta_bytes = deltas.mean_bytes();
  result.key_bytes = keys.mean_bytes();
  result.encode = median(deltas.encode);
  result.decode = median(deltas.decode);
  result.encode_key = median(keys.encode);
  result.decode_key = median(keys.decode);
  return result;
}

}  // namespace vat::bench
