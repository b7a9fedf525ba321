#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "core/simulation/simulation.h"
#include "protocol/frame/frame_codec.h"

namespace vat {

/// Precision and key frames of a recording.
struct RecorderSettings {
  double frame_seconds = 0;              ///< simulated time between two frames [s]
  std::optional<double> max_error;       ///< [m]; absent: default_max_error()
  std::optional<std::size_t> key_every;  ///< absent: default_key_interval()
};

/// Returns the number of frames from one key frame to the next. A viewer decodes all frames from a
/// key frame to the wanted frame in less than 100 ms, if the scene has at most 200 000 particles.
std::size_t default_key_interval(std::size_t particles);

/// Encoder of the frames of a recording. The next frame depends only on the simulation, on the
/// settings and on the preceding frames since the last key frame. A resumed recording therefore has
/// the same bytes.
class FrameRecorder {
 public:
  explicit FrameRecorder(const RecorderSettings& settings) : settings_(settings) {}

  /// Reads an existing frame. A resumed recording continues after the frames from the last key
  /// frame on. `number` is the number of the frame in the recording.
  Status read(std::span<const std::uint8_t> frame, std::size_t number);

  /// Encoded parts of a recording, valid until the next call.
  struct Parts {
    std::optional<std::string> description;  ///< JSON text, present if a description begins
    std::span<const std::uint8_t> frame;
  };
  /// Returns the next frame. A description begins if bodies have changed, for example by melting.
  Parts record(const Simulation& simulation);

 private:
  FrameScale next_scale(const Simulation& simulation) const;
  bool is_key_due(const Simulation& simulation, bool begins_description) const;
  bool have_bodies_changed() const;
  std::string describe(const Simulation& simulation) const;

  RecorderSettings settings_;
  FrameEncoder encoder_;
  FrameDecoder decoder_;
  StatePublisher publisher_;
  PublishedState state_;
  GridFrame frame_;            ///< the last frame, if there is one
  GridFrame before_;           ///< the frame before it, if `since_key_` > 0
  std::size_t count_ = 0;      ///< number of recorded frames
  std::size_t since_key_ = 0;  ///< distance of the last frame from its key frame
  std::uint32_t epoch_ = 0;
};

}  // namespace vat
