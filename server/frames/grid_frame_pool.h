#pragma once

#include <memory>
#include <vector>

#include "protocol/frame/grid_frame.h"

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

}  // namespace vat
