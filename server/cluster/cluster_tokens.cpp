#include "server/cluster/cluster_tokens.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <chrono>
#include <utility>

#include "protocol/json/json_reader.h"
#include "server/support/hex.h"
#include "server/support/log.h"

namespace vat {
namespace {

// After the longest validity of an invitation, 30 days.
constexpr std::chrono::hours kLife(31 * 24);
constexpr int kUseAttempts = 100;          // of concurrent uses
constexpr std::uint64_t kClockMargin = 2;  // minutes by which the clocks of two nodes may differ
constexpr std::uint64_t kMaxMinutes = 60;  // removed at once; the bucket removes older ones later

std::uint64_t minute_of(double time) {
  return static_cast<std::uint64_t>(time) / 60;
}

/// Key "SESSION.MINUTE.HASH". By its parts, the tokens of a session or of a minute are removed.
std::string token_key(const TokenHash& token, const TokenClaims& claims) {
  const std::string session = claims.session.empty() ? "all" : claims.session;
  const std::string hash(token.begin(), token.end());
  return session + '.' + std::to_string(claims.ends / 60) + '.' + to_hex(hash);
}

/// Calls `work`. Returns its result or the kind of its failure.
template <class Result, class Work>
Result try_tokens(const Work& work) {
  try {
    return work();
  } catch (const NatsError& error) {
    log_warning("the tokens of the cluster: {}", error.what());
    return StorageError::Kind::unreachable;
  } catch (const std::exception& error) {
    log_error("the tokens of the cluster: {}", error.what());
    return StorageError::Kind::corrupt;
  }
}

}  // namespace

ClusterTokens::ClusterTokens(NatsConnection& connection, boost::asio::any_io_executor executor,
                             const Clock& clock, std::string instance)
    : connection_(connection),
      bucket_(connection, "vat-tokens", kLife),
      executor_(std::move(executor)),
      clock_(clock),
      instance_(std::move(instance)),
      removed_minutes_(minute_of(clock.wall_time()) - kMaxMinutes) {}

void ClusterTokens::require_connection() const {
  if (connection_.is_connected()) return;
  throw NatsError(NatsError::Kind::disconnected, "there is no connection");
}

std::string ClusterTokens::value_of(std::optional<std::size_t> uses) {
  // The name of the write tells apart equal writes of two nodes.
  return Json{{"uses", uses ? Json(*uses) : Json()},
              {"write", instance_ + "." + std::to_string(++writes_)}}
      .dump();
}

void ClusterTokens::add(const TokenHash& token, const TokenClaims& claims,
                        std::optional<std::size_t> uses,
                        std::function<void(std::optional<StorageError::Kind>)> done) {
  using Failure = std::optional<StorageError::Kind>;
  boost::asio::post(executor_,
                    [this, key = token_key(token, claims), uses, done = std::move(done)] {
                      done(try_tokens<Failure>([&]() -> Failure {
                        require_connection();
                        remove_old();
                        bucket_.put(key, value_of(uses), Bucket::kNone);
                        return {};
                      }));
                    });
}

void ClusterTokens::use(const TokenHash& token, const TokenClaims& claims,
                        std::function<void(std::variant<bool, StorageError::Kind>)> done) {
  using Outcome = std::variant<bool, StorageError::Kind>;
  boost::asio::post(executor_, [this, key = token_key(token, claims), done = std::move(done)] {
    done(try_tokens<Outcome>([&] { return Outcome(count_use(key)); }));
  });
}

bool ClusterTokens::count_use(const std::string& key) {
  require_connection();
  for (int attempt = 1;; ++attempt) {
    const auto entry = bucket_.get(key);
    if (!entry) return false;
    const Json uses = Json::parse(entry->value).at("uses");
    if (uses.is_null()) return true;
    const auto left = uses.get<std::size_t>();
    if (left == 0) return false;
    try {
      bucket_.put(key, value_of(left - 1), entry->revision);
      return true;
    } catch (const NatsError& error) {
      if (error.kind() != NatsError::Kind::conflict || attempt == kUseAttempts) throw;
    }
  }
}

void ClusterTokens::remove_old() {
  const std::uint64_t end = minute_of(clock_.wall_time()) - kClockMargin;
  const std::uint64_t begin = std::max(removed_minutes_.exchange(end), end - kMaxMinutes);
  for (std::uint64_t minute = begin; minute < end; ++minute) {
    bucket_.purge("*." + std::to_string(minute) + ".*");
  }
}

void ClusterTokens::remove_session(const std::string& session) {
  boost::asio::post(executor_, [this, session] {
    try {
      bucket_.purge(session + ".>");
    } catch (const NatsError& error) {  // no node accepts a token of an ended session
      log_warning("the tokens of session {} are not removed: {}", session, error.what());
    }
  });
}

}  // namespace vat
