#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "protocol/frame/frame_codec.h"
#include "protocol/frame/frame_domain.h"
#include "protocol/frame/grid_frame.h"
#include "server/clients/client_outbox.h"
#include "server/frames/subscription.h"
#include "server/operations/server_metrics.h"

namespace vat {

/// Pool of frames that reuses the memory of released frames. The pool and its frames are not
/// thread-safe. Frames may outlive the pool.
class GridFramePool {
 public:
  /// Returns a frame with unspecified content.
  std::shared_ptr<GridFrame> take() {
    std::unique_ptr<GridFrame> frame;
    if (spare_->empty()) {
      frame = std::make_unique<GridFrame>();
    } else {
      frame = std::move(spare_->back());
      spare_->pop_back();
    }
    return {frame.release(), [spare = spare_](GridFrame* returned) {
              std::unique_ptr<GridFrame> owner(returned);
              if (spare->size() < kMaxSpare) spare->push_back(std::move(owner));
            }};
  }

 private:
  static constexpr std::size_t kMaxSpare = 4;
  using Spare = std::vector<std::unique_ptr<GridFrame>>;

  std::shared_ptr<Spare> spare_ = std::make_shared<Spare>();
};

/// Frames that a client can use as references, the newest first. Null: no frame.
using HeldFrames = std::array<std::shared_ptr<const GridFrame>, 2>;

/// Selection and quantisation of a viewer's frames. Viewers with equal cuts receive equal frames.
class FrameCut {
 public:
  FrameCut() = default;
  /// Errors are the requested errors times `coarseness`. The level of detail is at most `detail`.
  /// Positions without a requested error have the error `default_error` [m].
  FrameCut(const Subscription& subscription, double default_error, unsigned coarseness,
           std::uint8_t detail);

  double max_error() const { return max_error_; }
  double coarseness() const { return coarseness_; }
  const ByAttribute<double>& attribute_errors() const { return attribute_errors_; }
  FrameSelection selection() const;
  /// Returns a cut with the same errors for all particles.
  FrameCut of_all() const;

  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 reports a zero in the default
  auto operator<=>(const FrameCut&) const = default;

 private:
  double max_error_ = 0;
  double coarseness_ = 1;
  ByAttribute<double> attribute_errors_{};
  std::uint8_t detail_ = kFullDetail;
  bool has_region_ = false;
  std::array<double, 6> region_{};
};

/// Quantised and encoded frames of a session's states. Each state is quantised once per cut. Not
/// thread-safe.
class FrameSource {
 public:
  FrameSource(const std::optional<Vat>& vat, ServerMetrics& metrics);

  /// Restarts the grids after a scene change or a reset.
  void set_vat(const std::optional<Vat>& vat);
  /// Sets the state of the next frames. A state that differs from the last state gets a new number.
  /// Exchanges `state` for an older state.
  void publish(PublishedState& state);

  std::uint32_t number() const { return state_.header.number; }
  const FrameHeader& header() const { return state_.header; }
  /// Returns the quantised state. Equal cuts get the same frame until the next state.
  std::shared_ptr<const GridFrame> frame(const FrameCut& cut);
  /// Returns the frame, encoded relative to the usable reference frames in `held`.
  SharedFrame encode(const GridFrame& frame, const HeldFrames& held, std::uint8_t stride);

 private:
  FrameScale scale(const FrameCut& cut) const;

  ServerMetrics& metrics_;
  FrameDomain domain_;
  PublishedState state_;
  FrameEncoder encoder_;
  GridFramePool pool_;
  std::map<FrameCut, std::shared_ptr<const GridFrame>> frames_;  // frames of the last state
};

}  // namespace vat
