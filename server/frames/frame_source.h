#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "protocol/frame/frame_codec.h"
#include "protocol/frame/grid_frame.h"
#include "server/clients/client_outbox.h"
#include "server/frames/frame_domain.h"
#include "server/frames/subscription.h"
#include "server/operations/server_metrics.h"

namespace vat {

/// Reuses the memory of frames that nobody holds. Used by one thread at a time, as are its frames.
/// Frames may outlive the pool.
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

/// Frames that a client holds as references, the newest first; null: none.
using HeldFrames = std::array<std::shared_ptr<const GridFrame>, 2>;

/// Selection and quantisation of a viewer's frames. Viewers with equal cuts receive equal frames.
class FrameCut {
 public:
  FrameCut() = default;
  /// Errors are `coarseness` times the requested ones, and the detail is at most `detail`.
  /// Positions have the error `default_error` [m] if none was requested.
  FrameCut(const Subscription& subscription, double default_error, unsigned coarseness,
           std::uint8_t detail);

  double max_error() const { return max_error_; }
  double coarseness() const { return coarseness_; }
  const ByAttribute<double>& attribute_errors() const { return attribute_errors_; }
  FrameSelection selection() const;
  /// The same errors, for all particles.
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

/// Frames of a session's states. A state is quantised once per cut, and encoded once per cut and
/// pair of references. Used by one thread at a time.
class FrameSource {
 public:
  FrameSource(const std::optional<Vat>& vat, ServerMetrics& metrics);

  /// Restarts the grids, for another scene or a reset.
  void set_vat(const std::optional<Vat>& vat);
  /// Sets the state of the next frames. It gets a new number if it differs from the last one.
  /// Exchanges `state` for the memory of an older one.
  void publish(PublishedState& state);

  std::uint32_t number() const { return state_.header.number; }
  const FrameHeader& header() const { return state_.header; }
  /// Returns the quantised state. Equal cuts get the same frame until the next state.
  std::shared_ptr<const GridFrame> frame(const FrameCut& cut);
  /// Encodes the frame relative to the reference frames, as far as they can be used.
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
