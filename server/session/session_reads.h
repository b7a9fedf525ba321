#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/clients/pending_reply.h"
#include "server/clients/read_budget.h"
#include "server/session/core/session_command.h"
#include "server/session/core/session_environment.h"

namespace vat {

class SessionRun;
class SessionView;

/// Request whose result is computed on the read thread.
struct WaitingRead {
  PendingReply reply;
  Read read;
  std::string key;  ///< method, parameters and Read::copied; equal keys have equal results
};

/// Charges the budgets of the session and of the client with a result of `bytes` and its processor
/// time.
void charge_read(ReadBudget& of_session, ClientOutbox& client, std::size_t bytes,
                 std::chrono::duration<double> time, SteadyClock::time_point now);

/// Reads of a session that are computed one after another from one view of the session. Equal reads
/// share one result.
class ReadBatch {
 public:
  /// The environment must outlive the batch.
  ReadBatch(std::vector<WaitingRead> reads, std::unique_ptr<SessionView> view,
            std::shared_ptr<ReadBudget> budget, const SessionEnvironment& environment);
  ~ReadBatch();
  /// Answers all reads. Called once, on the read thread.
  void run();

 private:
  struct Result {
    SharedText text;  ///< null: `error` is the result
    std::optional<RpcError> error;
  };
  using Results = std::map<std::string, Result>;  // by WaitingRead::key
  void answer(WaitingRead& waiting, Results& results);
  /// Returns the limit of the client's queue if a result of this size must not be sent now.
  std::optional<RateExcess> find_full_queue(ClientOutbox& client, std::size_t bytes);
  Result compute(const WaitingRead& waiting);

  std::vector<WaitingRead> reads_;
  const std::unique_ptr<SessionView> view_;
  const std::shared_ptr<ReadBudget> budget_;
  const SessionEnvironment& environment_;
  // Messages that waited for each client at its first result, and the results since then [bytes].
  std::map<const ClientOutbox*, std::size_t> queued_;
};

/// Reads of a session that wait for the read thread. At most one batch of a session is computed at
/// a time, so that at most one view exists. Later reads wait for the next batch. Not thread-safe.
class SessionReads {
 public:
  explicit SessionReads(const SessionEnvironment& environment);

  /// Adds a read, or refuses it if the client or the session has exceeded its budget.
  void add(WaitingRead read);
  /// Refuses a read that is not part of a batch, if the client or the session has exceeded its
  /// budget. Returns whether the read is refused.
  bool refuse_excess(PendingReply& reply);
  /// Returns the budget of the session, for charge_read().
  const std::shared_ptr<ReadBudget>& budget() const { return budget_; }
  /// Returns the next batch, or null if a batch is being computed or no read waits. The caller must
  /// run the batch on the read thread, and then call end_batch().
  std::shared_ptr<ReadBatch> begin_batch(const SessionRun& run);
  void end_batch() { is_busy_ = false; }
  /// Answers all waiting reads with an error.
  void refuse_all(const RpcError& error);

 private:
  const SessionEnvironment& environment_;
  const std::shared_ptr<ReadBudget> budget_;  // batches may outlive the session
  std::vector<WaitingRead> waiting_;
  bool is_busy_ = false;
};

}  // namespace vat
