#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "protocol/client/exchange/call_error.h"

namespace vat::client {

using Json = nlohmann::json;
using Time = std::chrono::steady_clock::time_point;

/// Greatest number of calls that wait for replies.
inline constexpr std::size_t kMaxCalls = 1000;
/// Greatest size of the messages that wait for the network [bytes]. One message may be longer.
inline constexpr std::size_t kMaxOutputBytes = std::size_t{16} << 20;

/// A call without a reply.
struct Call {
  std::string method;
  Json params;
  Time deadline;
  std::function<void(Outcome<Json>)> settle;
};

/// Calls without replies, and messages to send. All threads may use a list. The functions call no
/// `settle`.
class CallList {
 public:
  /// Sender of a call. Calls of the application require open().
  enum class Origin { application, client };

  /// Adds a call and its message. Returns an error if the call cannot be sent. Throws
  /// std::invalid_argument if a text is not UTF-8.
  std::optional<CallError> add(Call call, Origin origin);
  /// Adds a notification. Returns false if it cannot be sent. Throws as add().
  bool add_notification(const std::string& method, const Json& params, Origin origin);

  /// Removes and returns a call. Returns nothing if it has already been removed.
  std::optional<Call> take(std::int64_t id);
  std::vector<Call> take_expired(Time now);
  /// Removes and returns all calls. Discards the messages to send and rejects further calls of the
  /// application until open().
  std::vector<Call> close();
  /// Accepts calls of the application.
  void open();
  /// Returns the earliest deadline of a call, or Time::max().
  Time next_deadline() const;
  /// Removes and returns the messages to send.
  std::vector<std::string> take_output();

 private:
  bool has_room() const { return output_bytes_ <= kMaxOutputBytes; }
  void put(std::string text);

  mutable std::mutex mutex_;
  bool is_open_ = false;
  std::int64_t last_id_ = 0;
  std::map<std::int64_t, Call> calls_;
  std::vector<std::string> output_;
  std::size_t output_bytes_ = 0;
};

}  // namespace vat::client
