#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "protocol/client/exchange/frame.h"
#include "protocol/frame/frame_codec.h"

namespace vat::client {

/// Decoder of the frames of a subscription, with the names and shapes of a description.
class FrameReceiver {
 public:
  struct Reception {
    const Frame* frame = nullptr;  ///< valid until the next call; null if the frame is invalid
    std::uint32_t number = 0;      ///< number to acknowledge; 0 if it cannot be read
    bool asks_for_key = false;     ///< the acknowledgement must ask for a key frame
    /// The frames are invalid although a key frame was requested. The connection must be opened
    /// again.
    bool is_broken = false;
    std::string fault = {};  ///< "" if there is no fault to report
  };

  /// Discards all frames, for example after a join.
  void restart();
  void describe(const SessionDescription& description);
  Reception receive(std::span<const std::uint8_t> bytes);

 private:
  struct Described {
    std::string name;
    std::vector<Vec3> local_positions;  // of a rigid body
  };
  /// Memory of a body in the frame.
  struct Room {
    std::vector<Vec3> positions;
    ByAttribute<std::vector<float>> attributes;
  };
  void fill(const GridFrame& grid);
  Frame::Body make_body(const GridFrame& grid, const GridBlock& block, Room& room) const;
  Reception refuse(std::span<const std::uint8_t> bytes, const Error& error);

  FrameDecoder decoder_;
  bool waits_for_key_ = false;
  std::map<std::uint32_t, Described> described_;  // by body
  std::vector<Room> rooms_;
  std::vector<Frame::Body> bodies_;
  Frame frame_;
};

}  // namespace vat::client
