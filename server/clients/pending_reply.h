#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/support/check.h"
#include "server/clients/client_outbox.h"
#include "server/messages/method_row.h"
#include "server/operations/server_metrics.h"

namespace vat {

/// Reply to a request, which is sent once. If the client has left, the object is destroyed without
/// a reply. The request then no longer counts as in flight.
class PendingReply {
 public:
  /// Without an id, the request is a notification and gets no reply.
  PendingReply(std::shared_ptr<ClientOutbox> client, std::optional<Json> id,
               ServerMetrics* metrics = nullptr)
      : client_(std::move(client)), id_(std::move(id)), metrics_(metrics) {}
  /// Reports an error to the client as that of a notification of this method.
  void set_notification(std::string method) { notification_ = std::move(method); }
  PendingReply(PendingReply&& other) noexcept
      : client_(std::move(other.client_)),
        id_(std::move(other.id_)),
        metrics_(other.metrics_),
        notification_(std::move(other.notification_)),
        method_(other.method_),
        counted_bytes_(std::exchange(other.counted_bytes_, std::nullopt)) {}
  PendingReply& operator=(PendingReply&& other) noexcept {
    std::swap(client_, other.client_);
    std::swap(id_, other.id_);
    std::swap(metrics_, other.metrics_);
    std::swap(notification_, other.notification_);
    std::swap(method_, other.method_);
    std::swap(counted_bytes_, other.counted_bytes_);
    return *this;
  }
  ~PendingReply() { uncount(); }

  const std::shared_ptr<ClientOutbox>& client() const { return client_; }

  /// Returns the called method. The dispatcher sets the method before handlers and sessions get the
  /// reply.
  const MethodRow& method() const {
    VAT_CHECK(method_ != nullptr);
    return *method_;
  }
  void set_method(const MethodRow& method) { method_ = &method; }

  /// Counts the request, a message of `bytes`, as in flight until the reply. Returns an error if
  /// the client has too many requests in flight.
  std::optional<RpcError> count(std::size_t bytes, std::size_t max_commands,
                                std::size_t max_bytes) {
    if (const auto excess = client_->begin_command(bytes, max_commands, max_bytes)) {
      return limit_reached(*excess);
    }
    counted_bytes_ = bytes;
    return {};
  }

  /// Returns false for a notification.
  bool wants_answer() const { return id_.has_value(); }

  void answer(const RpcResult& result) {
    if (metrics_ != nullptr) count_refusal(result);
    uncount();  // first, because the client may send a command as soon as it gets the reply
    if (id_) {
      client_->send(write_reply(*id_, result));
    } else if (const auto* error = std::get_if<RpcError>(&result);
               error != nullptr && !notification_.empty()) {
      client_->report_rejected(notification_, *error);
    }
  }

  /// Answers with a result whose text is `head` followed by `tail`. The tail also ends the message
  /// with a closing brace, and several replies can share the tail.
  void answer_text(std::string_view head, const SharedText& tail) {
    uncount();
    if (id_) client_->send(begin_reply(*id_).append(head), tail);
  }

 private:
  void count_refusal(const RpcResult& result) {
    const auto* error = std::get_if<RpcError>(&result);
    if (error == nullptr || error->kind != ErrorKind::limit_reached) return;
    metrics_->add_refusal(error->data.at("limit").get_ref<const std::string&>());
  }
  void uncount() {
    if (counted_bytes_) client_->end_command(*std::exchange(counted_bytes_, std::nullopt));
  }

  std::shared_ptr<ClientOutbox> client_;
  std::optional<Json> id_;
  ServerMetrics* metrics_;    // null: refusals are not counted
  std::string notification_;  // method; empty: a request, or a call by the server itself
  const MethodRow* method_ = nullptr;
  std::optional<std::size_t> counted_bytes_;
};

}  // namespace vat
