#pragma once

#include <cstdint>
#include <map>

#include "protocol/frame_codec.h"
#include "server/server_metrics.h"
#include "server/session/client_outbox.h"
#include "server/session/frame_domain.h"

namespace vat {

/// The frames of a session, encoded once for all who take them at one accuracy, and not at all
/// where nothing has moved. Used by one thread at a time.
class FrameSource {
 public:
  FrameSource(const std::optional<Vat>& vat, ServerMetrics& metrics);

  /// The grids of another scene, or of the same from its start.
  void set_vat(const std::optional<Vat>& vat);
  /// A further state, from which frames are made from now on; `watchers` bounds what is kept. It
  /// gets the next number where it shows something new.
  void publish(PublishedState state, std::size_t watchers);

  /// Names what a frame of this accuracy shows: two that differ only in when they were made, or by
  /// less than their grid tells, show the same. Never 0.
  std::uint64_t content(double max_error);
  /// The frame of the last published state.
  SharedFrame frame(double max_error);

 private:
  struct Encoded {
    SharedFrame frame;
    GridFrame shown;
    FrameGrid grid;
    std::uint64_t content = 0;
    std::uint64_t places = 0;       // of the state that it was made of
    std::uint64_t publication = 0;  // the same
  };
  Encoded& find(double max_error);
  void encode(Encoded& encoded);

  ServerMetrics& metrics_;
  FrameDomain domain_;
  PublishedState state_;
  std::uint64_t places_ = 0;       // counts states that differ in more than time
  std::uint64_t publication_ = 0;  // counts states
  std::uint64_t last_content_ = 0;
  FrameEncoder encoder_;
  std::map<double, Encoded> encoded_;  // by quantum
};

}  // namespace vat
