#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/frame/frame_codec.h"
#include "protocol/json/json_reader.h"
#include "server/script/transcript.h"
#include "server/transport/transport.h"
#include "tests/support/patience.h"

namespace vat::test {

/// A connection without a network: keeps what is sent to it. Its socket takes everything at once
/// unless it is stalled.
class FakeConnection final : public Connection {
 public:
  /// How long a test waits for what must come, before it fails.
  static constexpr std::chrono::seconds kPatience{30 * kSlowdown};

  explicit FakeConnection(ConnectionId id, std::string address = "127.0.0.1")
      : id_(id), address_(std::move(address)) {}

  ConnectionId id() const override { return id_; }
  const std::string& address() const override { return address_; }
  void send_text(std::string message) override {
    const bool is_reply = message.find(R"("id":)") != std::string::npos;
    if (failing_ || (is_reply && fail_next_reply_.exchange(false)))
      throw std::runtime_error("no memory for this message");
    if (record_ != nullptr) record_->received(std::to_string(id_), message);
    change([&] {
      add_queued(message.size());
      texts_.push_back(Json::parse(message));
    });
  }
  void send_binary(std::shared_ptr<const std::string> bytes) override {
    change([&] {
      add_queued(bytes->size());
      frames_.push_back(decode(*bytes));
    });
  }
  std::size_t queued_bytes() const override {
    const std::lock_guard lock(mutex_);
    return queued_;
  }
  void close(std::uint16_t code, std::string_view) override {
    change([&] { close_code_ = code; });
  }

  /// Writes what is sent from now on; `record` must outlive this, and may be null.
  void record(script::Transcript* record) { record_ = record; }

  /// The peer reads nothing more (or all again).
  void stall(bool stalled) {
    const std::lock_guard lock(mutex_);
    stalled_ = stalled;
    if (!stalled) queued_ = 0;
  }
  /// Each text that is sent throws.
  void fail(bool failing) { failing_ = failing; }
  /// The next reply does.
  void fail_next_reply() { fail_next_reply_ = true; }

  std::vector<Json> texts() const {
    const std::lock_guard lock(mutex_);
    return texts_;
  }
  std::vector<GridFrame> frames() const {
    const std::lock_guard lock(mutex_);
    return frames_;
  }
  std::size_t frame_count() const {
    const std::lock_guard lock(mutex_);
    return frames_.size();
  }
  GridFrame frame(std::size_t index) const {
    const std::lock_guard lock(mutex_);
    return frames_.at(index);
  }
  std::size_t queued() const { return queued_bytes(); }
  std::optional<std::uint16_t> close_code() const {
    const std::lock_guard lock(mutex_);
    return close_code_;
  }

  /// The first text from index `from` on that fits; absent if none has come.
  std::optional<Json> find_text(const std::function<bool(const Json&)>& fits,
                                std::size_t from = 0) const {
    const std::lock_guard lock(mutex_);
    for (std::size_t i = from; i < texts_.size(); ++i) {
      if (fits(texts_[i])) return texts_[i];
    }
    return {};
  }
  /// The first text from position `from` on that fits, once it is there.
  Json wait_text(const std::function<bool(const Json&)>& fits, std::size_t from = 0) {
    std::unique_lock lock(mutex_);
    std::size_t next = from;
    const bool found = changed_.wait_for(lock, kPatience, [&] {
      while (next < texts_.size() && !fits(texts_[next])) ++next;
      return next < texts_.size();
    });
    if (!found) throw std::runtime_error("a message that must come did not come");
    return texts_[next];
  }
  /// Waits for that many frames.
  void wait_frames(std::size_t count) {
    wait([&] { return frames_.size() >= count; });
  }
  void wait_closed() {
    wait([&] { return close_code_.has_value(); });
  }

 private:
  /// As a client that gets all frames in their order.
  GridFrame decode(const std::string& bytes) {
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    const Result<const GridFrame*> frame = decoder_.decode({data, bytes.size()});
    if (!frame) throw std::runtime_error("a frame is damaged: " + frame.errors().front().message);
    return *frame.value();
  }
  void add_queued(std::size_t bytes) {
    if (stalled_) queued_ += bytes;
  }
  void change(const std::function<void()>& change_it) {
    {
      const std::lock_guard lock(mutex_);
      change_it();
    }
    changed_.notify_all();
  }
  void wait(const std::function<bool()>& condition) {
    std::unique_lock lock(mutex_);
    if (!changed_.wait_for(lock, kPatience, condition)) {
      throw std::runtime_error("what must come did not come");
    }
  }

  const ConnectionId id_;
  const std::string address_;
  script::Transcript* record_ = nullptr;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Json> texts_;
  FrameDecoder decoder_;
  std::vector<GridFrame> frames_;
  std::size_t queued_ = 0;
  bool stalled_ = false;
  std::atomic<bool> failing_ = false;
  std::atomic<bool> fail_next_reply_ = false;
  std::optional<std::uint16_t> close_code_;
};

}  // namespace vat::test
