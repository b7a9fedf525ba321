#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "protocol/frame/frame_codec.h"
#include "server/server_metrics.h"
#include "server/session/client_outbox.h"
#include "server/session/frame_domain.h"
#include "server/session/grid_frame_pool.h"
#include "server/session/subscription.h"

namespace vat {

/// Frames as a client has got them, the newest first; null where there are none.
using HeldFrames = std::array<std::shared_ptr<const GridFrame>, 2>;

/// What of a state a viewer is shown, and in what steps. Viewers with equal cuts see the same.
class FrameCut {
 public:
  FrameCut() = default;
  /// `coarseness` times the errors that were asked for, and no more than `detail`. Positions
  /// without one have the error `default_error` [m].
  FrameCut(const Subscription& wish, double default_error, unsigned coarseness,
           std::uint8_t detail);

  double max_error() const { return max_error_; }
  double coarseness() const { return coarseness_; }
  const ByAttribute<double>& attribute_errors() const { return attribute_errors_; }
  FrameSelection selection() const;
  /// The same of all particles.
  FrameCut of_all() const;

  // NOLINTNEXTLINE(modernize-use-nullptr): a zero that clang-tidy 14 sees in what is not written
  auto operator<=>(const FrameCut&) const = default;

 private:
  double max_error_ = 0;
  double coarseness_ = 1;
  ByAttribute<double> attribute_errors_{};
  std::uint8_t detail_ = kFullDetail;
  bool has_region_ = false;
  std::array<double, 6> region_{};
};

/// The frames of a session's states: quantised once for all who are shown the same, and encoded
/// once for all of them who hold the same frames to build on. Used by one thread at a time.
class FrameSource {
 public:
  FrameSource(const std::optional<Vat>& vat, ServerMetrics& metrics);

  /// The grids of another scene, or of the same from its start.
  void set_vat(const std::optional<Vat>& vat);
  /// A further state, of which frames are made from now on. It gets the next number where it shows
  /// something new. The one before is left in its place.
  void publish(PublishedState& state);

  std::uint32_t number() const { return state_.header.number; }
  const FrameHeader& header() const { return state_.header; }
  /// The state in a viewer's steps: of equal cuts the same frame, until the next state.
  std::shared_ptr<const GridFrame> frame(const FrameCut& cut);
  /// The bytes for who holds these frames, as far as one can build on them.
  SharedFrame encode(const GridFrame& frame, const HeldFrames& held, std::uint8_t stride);

 private:
  FrameScale scale(const FrameCut& cut) const;

  ServerMetrics& metrics_;
  FrameDomain domain_;
  PublishedState state_;
  FrameEncoder encoder_;
  GridFramePool pool_;
  std::map<FrameCut, std::shared_ptr<const GridFrame>> frames_;  // of the last state
};

}  // namespace vat
