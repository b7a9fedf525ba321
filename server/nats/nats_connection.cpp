#include "server/nats/nats_connection.h"

#include <nats/nats.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <future>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "server/support/log.h"

namespace vat {
namespace {

using NatsClock = std::chrono::steady_clock;

constexpr std::int64_t kConnectMilliseconds = 2000;
constexpr std::int64_t kReconnectMilliseconds = 100;
constexpr std::int64_t kReconnectJitterMilliseconds = 100;
constexpr std::int64_t kWriteMilliseconds = 1000;
constexpr std::int64_t kPingMilliseconds = 1000;  // detects a server without a closed socket
constexpr int kMaxPingsOut = 2;
// Messages are not stored while there is no connection: their sender decides what to do.
constexpr int kReconnectBufferBytes = 1;

void check_nats(natsStatus status, const std::string& operation) {
  if (status == NATS_OK) return;
  const bool is_disconnected = status == NATS_CONNECTION_CLOSED ||
                               status == NATS_CONNECTION_DISCONNECTED || status == NATS_NO_SERVER ||
                               status == NATS_INSUFFICIENT_BUFFER;
  const auto kind = is_disconnected          ? NatsError::Kind::disconnected
                    : status == NATS_TIMEOUT ? NatsError::Kind::unreachable
                                             : NatsError::Kind::refused;
  throw NatsError(kind, operation + ": " + natsStatus_GetText(status));
}

std::string text_or_empty(const char* text) {
  return text == nullptr ? std::string() : std::string(text);
}

NatsMessage to_nats_message(natsMsg* message) {
  NatsMessage result;
  result.subject = text_or_empty(natsMsg_GetSubject(message));
  result.reply_to = text_or_empty(natsMsg_GetReply(message));
  const int length = natsMsg_GetDataLength(message);
  if (length > 0) result.data.assign(natsMsg_GetData(message), static_cast<std::size_t>(length));
  const char** keys = nullptr;
  int count = 0;
  if (natsMsgHeader_Keys(message, &keys, &count) != NATS_OK) return result;
  for (int i = 0; i < count; ++i) {
    const char* value = nullptr;
    if (natsMsgHeader_Get(message, keys[i], &value) == NATS_OK) {
      result.headers[keys[i]] = text_or_empty(value);
    }
  }
  std::free(keys);  // the keys themselves belong to the message
  return result;
}

struct OptionsDeleter {
  void operator()(natsOptions* options) const { natsOptions_Destroy(options); }
};

std::unique_ptr<natsOptions, OptionsDeleter> make_nats_options(const NatsSettings& settings) {
  natsOptions* raw = nullptr;
  check_nats(natsOptions_Create(&raw), "NATS options");
  std::unique_ptr<natsOptions, OptionsDeleter> options(raw);
  std::vector<const char*> urls;
  urls.reserve(settings.urls.size());
  for (const std::string& url : settings.urls) urls.push_back(url.c_str());
  const auto set = [](natsStatus status) { check_nats(status, "a setting of NATS"); };
  set(natsOptions_SetServers(raw, urls.data(), static_cast<int>(urls.size())));
  set(natsOptions_SetName(raw, settings.name.c_str()));
  set(natsOptions_SetTimeout(raw, kConnectMilliseconds));
  set(natsOptions_SetMaxReconnect(raw, -1));
  set(natsOptions_SetReconnectWait(raw, kReconnectMilliseconds));
  set(natsOptions_SetReconnectJitter(raw, kReconnectJitterMilliseconds,
                                     kReconnectJitterMilliseconds));
  set(natsOptions_SetReconnectBufSize(raw, kReconnectBufferBytes));
  set(natsOptions_SetPingInterval(raw, kPingMilliseconds));
  set(natsOptions_SetMaxPingsOut(raw, kMaxPingsOut));
  set(natsOptions_SetSendAsap(raw, true));
  set(natsOptions_SetWriteDeadline(raw, kWriteMilliseconds));
  if (!settings.tls_ca.empty()) {
    set(natsOptions_LoadCATrustedCertificates(raw, settings.tls_ca.c_str()));
  }
  if (!settings.tls_certificate.empty()) {
    set(natsOptions_LoadCertificatesChain(raw, settings.tls_certificate.c_str(),
                                          settings.tls_key.c_str()));
  }
  if (!settings.credentials.empty()) {
    set(natsOptions_SetUserCredentialsFromFiles(raw, settings.credentials.c_str(), nullptr));
  }
  return options;
}

}  // namespace

struct NatsConnection::Subscription::State {
  natsSubscription* subscription = nullptr;
  Handler handler;
  std::mutex mutex;  // held while the handler runs
  bool is_ended = false;

  ~State() { natsSubscription_Destroy(subscription); }
};

NatsConnection::Subscription::~Subscription() {
  const std::lock_guard lock(state_->mutex);
  state_->is_ended = true;
  natsSubscription_Unsubscribe(state_->subscription);
}

struct NatsConnection::Impl {
  struct Waiting {
    NatsClock::time_point deadline;
    std::function<void(Result)> done;
  };

  natsConnection* connection = nullptr;
  natsSubscription* inbox = nullptr;
  std::string inbox_prefix;
  std::function<void()> reconnected;
  std::atomic<bool> is_closing = false;
  std::promise<void> closed;  // after all other callbacks of the connection

  std::mutex mutex;  // guards the members below
  std::condition_variable wakes;
  std::map<std::string, Waiting> waiting;
  std::uint64_t last_request = 0;
  bool stopping = false;
  std::thread timer;  // fails requests whose time is over

  static void received(natsConnection*, natsSubscription*, natsMsg* message, void* closure) {
    static_cast<Impl*>(closure)->answer(to_nats_message(message));
    natsMsg_Destroy(message);
  }
  static void disconnected_callback(natsConnection*, void* closure) {
    auto* const self = static_cast<Impl*>(closure);
    if (!self->is_closing) log_warning("the connection to NATS is lost");
    self->fail_all(NatsError::Kind::unreachable);
  }
  static void closed_callback(natsConnection*, void* closure) {
    static_cast<Impl*>(closure)->closed.set_value();
  }
  static void reconnected_callback(natsConnection*, void* closure) {
    log_info("NATS is connected again");
    const auto* self = static_cast<Impl*>(closure);
    if (self->reconnected) self->reconnected();
  }
  static void error_callback(natsConnection*, natsSubscription*, natsStatus error, void*) {
    log_warning("NATS: {}", natsStatus_GetText(error));
  }

  void answer(NatsMessage message) {
    Waiting request;
    {
      const std::lock_guard lock(mutex);
      const auto found = waiting.find(message.subject);
      if (found == waiting.end()) return;  // its time was over
      request = std::move(found->second);
      waiting.erase(found);
    }
    const auto status = message.headers.find("Status");
    if (status != message.headers.end() && status->second == "503") {
      return request.done(NatsError(NatsError::Kind::unreachable, "no server answers"));
    }
    request.done(std::move(message));
  }

  void fail(const std::vector<Waiting>& requests, NatsError::Kind kind, const char* reason) {
    for (const Waiting& request : requests) request.done(NatsError(kind, reason));
  }

  void fail_all(NatsError::Kind kind) {
    std::vector<Waiting> failed;
    {
      const std::lock_guard lock(mutex);
      for (auto& [subject, request] : waiting) failed.push_back(std::move(request));
      waiting.clear();
    }
    fail(failed, kind, "the connection to NATS is lost");
  }

  void run_timer() {
    std::unique_lock lock(mutex);
    while (!stopping) {
      const auto now = NatsClock::now();
      auto next = now + std::chrono::hours(1);
      std::vector<Waiting> late;
      for (auto entry = waiting.begin(); entry != waiting.end();) {
        if (entry->second.deadline <= now) {
          late.push_back(std::move(entry->second));
          entry = waiting.erase(entry);
        } else {
          next = std::min(next, entry->second.deadline);
          ++entry;
        }
      }
      if (late.empty()) {
        wakes.wait_until(lock, next);
        continue;
      }
      lock.unlock();
      fail(late, NatsError::Kind::unreachable, "NATS does not answer");
      lock.lock();
    }
  }

  /// Returns the subject on which the answer is expected.
  std::string expect(Milliseconds timeout, std::function<void(Result)> done) {
    const std::lock_guard lock(mutex);
    std::string subject = inbox_prefix + std::to_string(++last_request);
    waiting[subject] = {NatsClock::now() + timeout, std::move(done)};
    wakes.notify_one();
    return subject;
  }

  std::optional<Waiting> withdraw(const std::string& subject) {
    const std::lock_guard lock(mutex);
    auto found = waiting.extract(subject);
    if (!found) return {};
    return std::move(found.mapped());
  }
};

NatsConnection::NatsConnection(const NatsSettings& settings) : impl_(std::make_unique<Impl>()) {
  const auto options = make_nats_options(settings);
  Impl& impl = *impl_;
  natsOptions_SetDisconnectedCB(options.get(), &Impl::disconnected_callback, &impl);
  natsOptions_SetClosedCB(options.get(), &Impl::closed_callback, &impl);
  natsOptions_SetReconnectedCB(options.get(), &Impl::reconnected_callback, &impl);
  natsOptions_SetErrorHandler(options.get(), &Impl::error_callback, &impl);
  check_nats(natsConnection_Connect(&impl.connection, options.get()), "NATS cannot be reached");
  natsInbox* name = nullptr;
  natsStatus status = natsInbox_Create(&name);
  if (status == NATS_OK) {
    impl.inbox_prefix = text_or_empty(name) + ".";
    natsInbox_Destroy(name);
    status = natsConnection_Subscribe(&impl.inbox, impl.connection,
                                      (impl.inbox_prefix + "*").c_str(), &Impl::received, &impl);
  }
  if (status != NATS_OK) {
    impl.is_closing = true;
    natsConnection_Close(impl.connection);
    impl.closed.get_future().wait();
    natsConnection_Destroy(impl.connection);
    check_nats(status, "NATS inbox");
  }
  natsSubscription_SetPendingLimits(impl.inbox, -1, -1);
  impl.timer = std::thread([&impl] { impl.run_timer(); });
}

NatsConnection::~NatsConnection() {
  close();
  natsSubscription_Destroy(impl_->inbox);
  natsConnection_Destroy(impl_->connection);
}

void NatsConnection::close() {
  if (impl_->is_closing.exchange(true)) return;
  natsConnection_Close(impl_->connection);
  impl_->closed.get_future().wait();
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->stopping = true;
  }
  impl_->wakes.notify_one();
  impl_->timer.join();
  impl_->fail_all(NatsError::Kind::unreachable);
}

bool NatsConnection::is_connected() const {
  return natsConnection_Status(impl_->connection) == NATS_CONN_STATUS_CONNECTED;
}

void NatsConnection::on_reconnect(std::function<void()> function) {
  impl_->reconnected = std::move(function);
}

void NatsConnection::publish(const std::string& subject, const std::string& data) {
  check_nats(natsConnection_Publish(impl_->connection, subject.c_str(), data.data(),
                                    static_cast<int>(data.size())),
             subject);
}

void NatsConnection::request(const std::string& subject, const Headers& headers,
                             const std::string& data, Milliseconds timeout,
                             std::function<void(Result)> done) {
  if (!is_connected()) {
    return done(NatsError(NatsError::Kind::disconnected, "there is no connection to NATS"));
  }
  const std::string answer_to = impl_->expect(timeout, std::move(done));
  natsMsg* message = nullptr;
  natsStatus status = natsMsg_Create(&message, subject.c_str(), answer_to.c_str(), data.data(),
                                     static_cast<int>(data.size()));
  for (const auto& [key, value] : headers) {
    if (status == NATS_OK) status = natsMsgHeader_Set(message, key.c_str(), value.c_str());
  }
  if (status == NATS_OK) status = natsConnection_PublishMsg(impl_->connection, message);
  natsMsg_Destroy(message);
  if (status == NATS_OK) return;
  // The answer, or the end of the connection, may have come already.
  if (const auto waiting = impl_->withdraw(answer_to)) {
    try {
      check_nats(status, subject);
    } catch (const NatsError& error) {
      waiting->done(error);
    }
  }
}

NatsMessage NatsConnection::request(const std::string& subject, const std::string& data,
                                    Milliseconds timeout, const Headers& headers) {
  const auto promise = std::make_shared<std::promise<Result>>();
  request(subject, headers, data, timeout,
          [promise](Result result) { promise->set_value(std::move(result)); });
  Result result = promise->get_future().get();
  if (const auto* error = std::get_if<NatsError>(&result)) {
    throw NatsError(error->kind(), subject + ": " + error->what());
  }
  return std::get<NatsMessage>(std::move(result));
}

std::unique_ptr<NatsConnection::Subscription> NatsConnection::subscribe(const std::string& subject,
                                                                        Handler handler) {
  auto state = std::make_shared<Subscription::State>();
  state->handler = std::move(handler);
  // The library calls `completed` after the last message, and until then needs the state.
  auto* const kept = new std::shared_ptr<Subscription::State>(state);
  const natsMsgHandler received = [](natsConnection*, natsSubscription*, natsMsg* message,
                                     void* closure) {
    Subscription::State& to = **static_cast<std::shared_ptr<Subscription::State>*>(closure);
    const std::lock_guard lock(to.mutex);
    if (!to.is_ended) to.handler(to_nats_message(message));
    natsMsg_Destroy(message);
  };
  const natsStatus status = natsConnection_Subscribe(&state->subscription, impl_->connection,
                                                     subject.c_str(), received, kept);
  if (status != NATS_OK) {
    delete kept;
    check_nats(status, subject);
  }
  natsSubscription_SetPendingLimits(state->subscription, -1, -1);
  natsSubscription_SetOnCompleteCB(
      state->subscription,
      [](void* closure) { delete static_cast<std::shared_ptr<Subscription::State>*>(closure); },
      kept);
  return std::make_unique<Subscription>(std::move(state));
}

void NatsConnection::flush(Milliseconds timeout) {
  check_nats(natsConnection_FlushTimeout(impl_->connection, timeout.count()), "NATS flush");
}

}  // namespace vat
