#pragma once

namespace vat {

/// Condition for messages of sessions. Thread-safe.
class SendGate {
 public:
  SendGate() = default;
  virtual ~SendGate() = default;
  SendGate(const SendGate&) = delete;
  SendGate& operator=(const SendGate&) = delete;

  /// Returns whether this server may send messages of its sessions now.
  virtual bool is_open() const = 0;
};

}  // namespace vat
