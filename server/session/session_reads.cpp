#include "server/session/session_reads.h"

#include <algorithm>
#include <ctime>
#include <exception>
#include <utility>

#include "server/session/core/session_run.h"
#include "server/session/core/session_view.h"
#include "server/support/log.h"
#include "server/support/low_priority.h"

namespace vat {
namespace {

/// The read thread uses the processor time that ticks and frames leave.
constexpr int kReadNiceness = 15;

std::chrono::duration<double> processor_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

std::optional<RateExcess> find_read_excess(const PendingReply& reply, ReadBudget& of_session,
                                           SteadyClock::time_point now) {
  ReadBudget* const of_client = reply.client()->read_budget();
  if (of_client != nullptr) {
    if (auto excess = of_client->find_excess(now)) return excess;
  }
  return of_session.find_excess(now);
}

void refuse_read(PendingReply& reply, const RateExcess& excess, ServerMetrics& metrics) {
  metrics.add_rate_limited(excess.limit);
  reply.answer(rate_limited(excess.limit, excess.maximum, excess.retry_after.count()));
}

}  // namespace

void charge_read(ReadBudget& of_session, ClientOutbox& client, std::size_t bytes,
                 std::chrono::duration<double> time, SteadyClock::time_point now) {
  of_session.charge(bytes, time, now);
  if (ReadBudget* const of_client = client.read_budget()) of_client->charge(bytes, time, now);
}

ReadBatch::ReadBatch(std::vector<WaitingRead> reads, std::unique_ptr<SessionView> view,
                     std::shared_ptr<ReadBudget> budget, const SessionEnvironment& environment)
    : reads_(std::move(reads)),
      view_(std::move(view)),
      budget_(std::move(budget)),
      environment_(environment) {}
ReadBatch::~ReadBatch() = default;

void ReadBatch::run() {
  thread_local const bool is_low = (lower_thread_priority(kReadNiceness, "vat-reads"), true);
  static_cast<void>(is_low);
  Results results;
  for (WaitingRead& waiting : reads_) {
    try {
      answer(waiting, results);
    } catch (const std::exception& error) {
      log_error("a read was not answered: {}", error.what());
    }
  }
  reads_.clear();
}

void ReadBatch::answer(WaitingRead& waiting, Results& results) {
  if (const auto excess = find_read_excess(waiting.reply, *budget_, environment_.clock.now())) {
    return refuse_read(waiting.reply, *excess, environment_.metrics);
  }
  const auto begin = processor_time();
  auto found = results.find(waiting.key);
  if (found == results.end()) found = results.emplace(waiting.key, compute(waiting)).first;
  const Result& result = found->second;
  const auto time = processor_time() - begin;
  const std::size_t bytes = result.text == nullptr ? 0 : result.text->size();
  charge_read(*budget_, *waiting.reply.client(), bytes, time, environment_.clock.now());
  if (result.error) {
    waiting.reply.answer(*result.error);
  } else if (const auto excess = find_full_queue(*waiting.reply.client(), bytes)) {
    refuse_read(waiting.reply, *excess, environment_.metrics);
  } else {
    waiting.reply.answer_text({}, result.text);
  }
}

std::optional<RateExcess> ReadBatch::find_full_queue(ClientOutbox& client, std::size_t bytes) {
  const ServerLimits& limits = environment_.limits;
  const std::size_t maximum = limits.max_control_queue_bytes;
  const auto [entry, is_first] = queued_.try_emplace(&client, 0);
  std::size_t& queued = entry->second;
  if (is_first) {
    QueueMemory memory;
    client.add_queue(memory);
    queued = memory.bytes();
  }
  const std::size_t cost = bytes + ControlQueue::kMessageCost;
  // The queue permits longer messages than its limit, but few of them.
  if (queued + (cost > maximum ? 0 : cost) > maximum) {
    const auto queue_bytes = static_cast<double>(queued);
    return RateExcess{"control_queue_bytes", static_cast<double>(maximum),
                      TokenBucket::Seconds(queue_bytes / limits.max_read_bytes_per_second)};
  }
  queued += cost;
  return {};
}

ReadBatch::Result ReadBatch::compute(const WaitingRead& waiting) {
  try {
    RpcResult made = waiting.read.make(*view_);
    if (auto* error = std::get_if<RpcError>(&made)) return {nullptr, std::move(*error)};
    Json& content = std::get<Json>(made);
    content["tick"] = view_->tick();
    return {std::make_shared<const std::string>(to_message_text(content) + '}'), {}};
  } catch (const StorageError& error) {
    log_error("a read failed: {}", error.what());
    return {nullptr, storage_failed(error.kind())};
  } catch (const std::exception& error) {
    log_error("a read failed: {}", error.what());
    return {nullptr, internal_error()};
  }
}

SessionReads::SessionReads(const SessionEnvironment& environment)
    : environment_(environment),
      budget_(session_read_budget(environment.limits, environment.clock.now())) {}

void SessionReads::add(WaitingRead read) {
  if (!refuse_excess(read.reply)) waiting_.push_back(std::move(read));
}

bool SessionReads::refuse_excess(PendingReply& reply) {
  const auto excess = find_read_excess(reply, *budget_, environment_.clock.now());
  if (excess) refuse_read(reply, *excess, environment_.metrics);
  return excess.has_value();
}

std::shared_ptr<ReadBatch> SessionReads::begin_batch(const SessionRun& run) {
  if (is_busy_ || waiting_.empty()) return nullptr;
  is_busy_ = true;
  const bool with_state = std::ranges::any_of(
      waiting_, [](const WaitingRead& waiting) { return waiting.read.needs_state; });
  const auto begin = processor_time();
  auto view = std::make_unique<SessionView>(run, with_state);
  budget_->charge(0, processor_time() - begin, environment_.clock.now());
  return std::make_shared<ReadBatch>(std::exchange(waiting_, {}), std::move(view), budget_,
                                     environment_);
}

void SessionReads::refuse_all(const RpcError& error) {
  for (WaitingRead& read : std::exchange(waiting_, {})) read.reply.answer(error);
}

}  // namespace vat
