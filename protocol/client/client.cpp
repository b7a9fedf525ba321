#include "protocol/client/client.h"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <random>
#include <thread>

#include "protocol/client/connection/web_socket.h"
#include "protocol/client/exchange/exchange.h"

namespace vat::client {
namespace {

using Clock = std::chrono::steady_clock;

constexpr unsigned kSwitchingProtocols = 101;
/// Time limit of the closing handshake.
constexpr std::chrono::seconds kFarewell{1};

void check_options(const Options& options) {
  const auto require = [](bool is_valid, const char* words) {
    if (!is_valid) throw std::invalid_argument(words);
  };
  require(options.timeout.count() > 0, "Options::timeout must be above 0");
  require(options.call_timeout.count() > 0, "Options::call_timeout must be above 0");
  require(options.first_retry.count() > 0, "Options::first_retry must be above 0");
  require(options.longest_retry >= options.first_retry,
          "Options::longest_retry must be at least Options::first_retry");
}

}  // namespace

class Client::Impl {
 public:
  Impl(const std::string& url, Options options, Handlers handlers)
      : url_(read_websocket_url(url)),
        options_(std::move(options)),
        handlers_(std::move(handlers)),
        exchange_(options_, handlers_, calls_, std::random_device{}()) {
    check_options(options_);
    // The constructor waits for the first state `open` or `closed`.
    handlers_.on_state = [this, given = std::move(handlers_.on_state)](const StateChange& change) {
      announce(change);
      if (given) given(change);
    };
    thread_ = std::thread([this] { run(); });
  }
  ~Impl() {
    stop();
    thread_.join();
  }

  /// Waits for the end of the first attempt. Throws ConnectError if it failed.
  void wait_until_open() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return is_decided_; });
    if (failure_) throw ConnectError(*failure_);
  }

  void start_call(const char* method, Json params,
                  const std::function<void(Outcome<Json>)>& settle) {
    const auto refused =
        calls_.add({method, std::move(params), Clock::now() + options_.call_timeout, settle},
                   CallList::Origin::application);
    if (refused) return settle(*refused);
    wake();
  }
  bool start_notification(const char* method, const Json& params) {
    const bool is_added = calls_.add_notification(method, params, CallList::Origin::application);
    if (is_added) wake();
    return is_added;
  }
  void stop() {
    const std::lock_guard lock(mutex_);
    is_stopping_ = true;
    changed_.notify_all();
    if (socket_) socket_->cancel();
  }
  bool runs_here() const { return std::this_thread::get_id() == runner_; }
  void wait_until_ended() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return has_ended_; });
  }

 private:
  void announce(const StateChange& change) {
    const std::lock_guard lock(mutex_);
    if (is_decided_) return;
    is_decided_ = change.state == ConnectionState::open || change.state == ConnectionState::closed;
    if (change.state == ConnectionState::closed) failure_ = change.reason;
    changed_.notify_all();
  }
  bool is_stopping() const {
    const std::lock_guard lock(mutex_);
    return is_stopping_;
  }
  /// Wakes the thread of the client, which sends the messages.
  void wake() {
    const std::lock_guard lock(mutex_);
    if (socket_) socket_->wake();
  }
  /// Replaces the socket. wake() and stop() use it on other threads.
  void set_socket(std::unique_ptr<WebSocket> socket) {
    const std::lock_guard lock(mutex_);
    socket_.swap(socket);
  }

  void run();
  void connect();
  void serve();
  void wait_for_retry();
  void end_connection();

  const WebSocketUrl url_;
  const Options options_;
  Handlers handlers_;
  CallList calls_;
  Exchange exchange_;  // only the thread of the client uses it

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::unique_ptr<WebSocket> socket_;
  bool is_stopping_ = false;
  bool is_decided_ = false;
  bool has_ended_ = false;
  std::optional<std::string> failure_;
  std::atomic<std::thread::id> runner_{};  ///< id of `thread_`, which the constructor assigns later
  std::thread thread_;
};

void Client::Impl::run() {
  runner_ = std::this_thread::get_id();
  exchange_.start_connecting();
  while (!is_stopping() && exchange_.state() != ConnectionState::closed) {
    if (exchange_.state() == ConnectionState::waiting) {
      wait_for_retry();
    } else if (!socket_) {
      connect();
    } else {
      serve();
    }
  }
  end_connection();
  exchange_.close("the client was closed");
  const std::lock_guard lock(mutex_);
  has_ended_ = true;
  changed_.notify_all();
}

void Client::Impl::connect() {
  try {
    const std::string& url = exchange_.next_url();
    set_socket(
        std::make_unique<WebSocket>(url.empty() ? url_ : read_websocket_url(url), options_.trust));
    if (is_stopping()) return;
    const unsigned status = socket_->connect({}, Clock::now() + options_.timeout);
    if (status != kSwitchingProtocols) {
      throw std::runtime_error("the server refuses the connection with the HTTP status " +
                               std::to_string(status));
    }
    exchange_.connected(Clock::now());
  } catch (const std::exception& error) {
    set_socket(nullptr);
    exchange_.lost(0, error.what(), Clock::now());
  }
}

void Client::Impl::serve() {
  for (const std::string& text : calls_.take_output()) socket_->send_text(text);
  const std::optional<Message> message = socket_->next(exchange_.next_check());
  if (message) exchange_.receive(*message, Clock::now());
  exchange_.check(Clock::now());
  if (exchange_.state() == ConnectionState::waiting) set_socket(nullptr);
}

void Client::Impl::wait_for_retry() {
  {
    std::unique_lock lock(mutex_);
    if (changed_.wait_until(lock, exchange_.retry_time(), [this] { return is_stopping_; })) return;
  }
  exchange_.start_connecting();
}

void Client::Impl::end_connection() {
  if (socket_ && exchange_.state() == ConnectionState::open) {
    for (const std::string& text : calls_.take_output()) socket_->send_text(text);
    socket_->close();
    const Time limit = Clock::now() + kFarewell;
    while (Clock::now() < limit) {
      const std::optional<Message> message = socket_->next(limit);
      if (message && message->kind == Message::Kind::closed) break;
    }
  }
  set_socket(nullptr);
}

Client::Client(const std::string& url, Options options, Handlers handlers)
    : impl_(std::make_unique<Impl>(url, std::move(options), std::move(handlers))) {
  impl_->wait_until_open();
}

Client::~Client() = default;

void Client::start_call(const char* method, Json params,
                        const std::function<void(Outcome<Json>)>& settle) {
  impl_->start_call(method, std::move(params), settle);
}

bool Client::start_notification(const char* method, const Json& params) {
  return impl_->start_notification(method, params);
}

void Client::close() {
  impl_->stop();
  if (!impl_->runs_here()) impl_->wait_until_ended();
}

}  // namespace vat::client
