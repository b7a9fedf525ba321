#include "server/transport/ws_task_queue.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <utility>

namespace vat {

namespace {

/// Returns the part of a reason that fits into a close frame, with complete characters. The library
/// refuses incomplete ones.
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

void WsTaskQueue::send(std::weak_ptr<WsStream> stream, WsMessage::ptr message) {
  put({std::move(stream), std::move(message), 0, {}, {}});
}

void WsTaskQueue::close(std::weak_ptr<WsStream> stream, std::uint16_t code, std::string reason) {
  put({std::move(stream), nullptr, code, std::move(reason), {}});
}

void WsTaskQueue::run(std::weak_ptr<WsStream> stream,
                      std::function<void(const std::shared_ptr<WsStream>&)> work) {
  put({std::move(stream), nullptr, 0, {}, std::move(work)});
}

void WsTaskQueue::shut() {
  std::vector<Task> left;
  const std::lock_guard lock(mutex_);
  io_ = nullptr;
  left.swap(tasks_);
}

void WsTaskQueue::put(Task task) {
  const std::lock_guard lock(mutex_);
  if (io_ == nullptr) return;
  tasks_.push_back(std::move(task));
  if (tasks_.size() > 1) return;  // the thread has been notified already
  // Weak: a stopped io_context keeps its posted tasks.
  boost::asio::post(*io_, [weak = weak_from_this()] {
    if (const auto self = weak.lock()) self->run_all();
  });
}

void WsTaskQueue::run_all() {
  std::vector<Task> tasks;
  {
    const std::lock_guard lock(mutex_);
    tasks.swap(tasks_);
  }
  for (Task& task : tasks) {
    const auto stream = task.stream.lock();
    if (!stream) continue;
    if (task.message) {
      // A closed stream refuses the message, which is then dropped.
      stream->send(std::move(task.message));
    } else if (task.work) {
      task.work(stream);
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
