#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <websocketpp/frame.hpp>
#include <websocketpp/message_buffer/alloc.hpp>

namespace vat {

/// Message type with the members that websocketpp requires. Several connections can share the
/// payload of a message. The token is destroyed when the message no longer waits for the socket.
class WsMessage {
 public:
  using ptr = std::shared_ptr<WsMessage>;
  using Manager = websocketpp::message_buffer::alloc::con_msg_manager<WsMessage>;
  using Opcode = websocketpp::frame::opcode::value;

  explicit WsMessage(const std::shared_ptr<Manager>&) {}
  WsMessage(const std::shared_ptr<Manager>&, Opcode opcode, std::size_t size) : opcode_(opcode) {
    own_payload_.reserve(size);
  }
  /// Creates a complete unmasked frame, whose payload is `head` followed by `payload`. The library
  /// writes the header before the payload, so `head` is stored with the header.
  WsMessage(Opcode opcode, std::shared_ptr<const std::string> payload, std::shared_ptr<void> token,
            const std::string& head = {})
      : shared_payload_(std::move(payload)),
        token_(std::move(token)),
        opcode_(opcode),
        prepared_(true) {
    namespace frame = websocketpp::frame;
    const std::uint64_t size = head.size() + shared_payload_->size();
    header_ = frame::prepare_header(frame::basic_header(opcode, size, true, false),
                                    frame::extended_header(size)) +
              head;
  }

  bool get_prepared() const { return prepared_; }
  void set_prepared(bool prepared) { prepared_ = prepared; }
  bool get_compressed() const { return false; }
  void set_compressed(bool) {}
  bool get_terminal() const { return terminal_; }
  void set_terminal(bool terminal) { terminal_ = terminal; }
  bool get_fin() const { return true; }
  Opcode get_opcode() const { return opcode_; }
  void set_opcode(Opcode opcode) { opcode_ = opcode; }
  const std::string& get_header() const { return header_; }
  void set_header(const std::string& header) { header_ = header; }
  const std::string& get_payload() const {
    return shared_payload_ ? *shared_payload_ : own_payload_;
  }
  std::string& get_raw_payload() { return own_payload_; }
  void set_payload(const std::string& payload) { own_payload_ = payload; }
  void append_payload(const std::string& payload) { own_payload_ += payload; }
  void append_payload(const void* bytes, std::size_t size) {
    own_payload_.append(static_cast<const char*>(bytes), size);
  }

 private:
  std::string header_;
  std::string own_payload_;
  std::shared_ptr<const std::string> shared_payload_;
  std::shared_ptr<void> token_;
  Opcode opcode_ = websocketpp::frame::opcode::CONTINUATION;
  bool prepared_ = false;
  bool terminal_ = false;
};

}  // namespace vat
