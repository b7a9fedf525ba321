#include "server/net/ws_lane.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <utility>

namespace vat {

namespace {

/// What fits into a close frame. Ends before a whole character: the library refuses half a one.
std::string fit_reason(const std::string& reason) {
  constexpr std::size_t kMaxSize = websocketpp::frame::limits::close_reason_size;
  std::size_t size = std::min(reason.size(), kMaxSize);
  if (size < reason.size()) {
    const auto inside_character = [](char byte) { return (byte & 0xc0) == 0x80; };
    while (size > 0 && inside_character(reason[size])) --size;
  }
  return reason.substr(0, size);
}

}  // namespace

void WsLane::send(std::weak_ptr<WsStream> stream, WsMessage::ptr message) {
  put({std::move(stream), std::move(message), 0, {}});
}

void WsLane::close(std::weak_ptr<WsStream> stream, std::uint16_t code, std::string reason) {
  put({std::move(stream), nullptr, code, std::move(reason)});
}

void WsLane::shut() {
  std::vector<Task> left;
  const std::lock_guard lock(mutex_);
  io_ = nullptr;
  left.swap(tasks_);
}

void WsLane::put(Task task) {
  const std::lock_guard lock(mutex_);
  if (io_ == nullptr) return;
  tasks_.push_back(std::move(task));
  if (tasks_.size() > 1) return;  // the thread has been called already
  // Weak: an io_context that is stopped keeps what was posted to it.
  boost::asio::post(*io_, [weak = weak_from_this()] {
    if (const auto lane = weak.lock()) lane->carry_out_all();
  });
}

void WsLane::carry_out_all() {
  std::vector<Task> tasks;
  {
    const std::lock_guard lock(mutex_);
    tasks.swap(tasks_);
  }
  for (Task& task : tasks) {
    const auto stream = task.stream.lock();
    if (!stream) continue;
    if (task.message) {
      // A stream that is no longer open refuses the message, which is then dropped as promised.
      stream->send(std::move(task.message));
    } else {
      close_stream(*stream, task.code, task.reason);
    }
  }
}

void close_stream(WsStream& stream, std::uint16_t code, const std::string& reason) {
  if (stream.get_state() != websocketpp::session::state::open) return;
  websocketpp::lib::error_code error;
  stream.close(code, fit_reason(reason), error);
  if (error) stream.terminate(error);
}

}  // namespace vat
