#include "server/storage/storage.h"

#include <boost/asio/post.hpp>
#include <chrono>
#include <exception>
#include <future>
#include <utility>
#include <vector>
#include "core/support/check.h"
#include "server/support/log.h"

namespace vat {
namespace {

constexpr double kSavedSeconds = 60;                          // of the budget of checkpoints
constexpr std::size_t kRecentBytes = std::size_t{256} << 20;  // of the page cache
constexpr auto kMoveInterval = std::chrono::seconds(1);
// While commands arrive, the copied part of a log is not reused. Beyond this size they wait some
// milliseconds once, so that it is.
constexpr std::size_t kMaxLogBytes = std::size_t{64} << 20;

template <class Store>
void move_log(Store& store) {
  if (store.move_log(false) > kMaxLogBytes) store.move_log(true);
}

std::string id_of(std::uint64_t session) {
  return "s" + std::to_string(session);
}

std::vector<std::string> ids_of(const std::vector<StoredSession>& sessions) {
  std::vector<std::string> ids;
  for (const StoredSession& session : sessions) ids.push_back(id_of(session.number));
  return ids;
}

}  // namespace

Storage::Storage(const std::string& folder, const StorageSettings& settings, Clock& clock)
    : folder_(folder),
      settings_(settings),
      clock_(clock),
      sessions_(folder_.file("vat.db"), settings.durability),
      checkpoints_(folder_.file("checkpoints.db"), settings.checkpoint_bytes,
                   settings.checkpoint_bytes_in_all),
      recent_states_(folder_.file("recent"), kRecentBytes),
      states_(folder_.file("states.db"), settings.durability),
      scenes_(sessions_.main()),
      tokens_(sessions_.main()),
      journal_(*sessions_.main(), clock),
      checkpoint_budget_(settings.checkpoint_bytes_per_second,
                         kSavedSeconds * settings.checkpoint_bytes_per_second, clock.now()),
      move_timer_(clock.make_timer(thread_.get_executor())) {
  states_.keep_only(ids_of(sessions_.sessions()));
  remove_closed();
  boost::asio::post(thread_, [this] { wait_to_move(); });
}

Storage::~Storage() {
  boost::asio::post(thread_, [this] {
    stopping_ = true;  // a task that is already queued cannot be cancelled
    move_timer_->cancel();
  });
  thread_.join();
}

void Storage::post(std::function<void()> task) {
  VAT_CHECK(task != nullptr);
  boost::asio::post(thread_, [this, task = std::move(task)] { run(task); });
}

void Storage::flush() {
  std::promise<void> done;
  boost::asio::post(thread_, [&done] { done.set_value(); });
  done.get_future().wait();
  journal_.flush();
}

void Storage::run(const std::function<void()>& task) {
  VAT_CHECK(thread_.get_executor().running_in_this_thread());
  try {
    task();
  } catch (const std::exception& error) {
    count_failure();
    log_error("storage: {}", error.what());
  }
}

StorageCounts Storage::counts() const {
  StorageCounts counts = journal_.counts();
  counts.failures += failures_;
  counts.checkpoints = checkpoints_written_;
  counts.checkpoint_bytes = checkpoint_bytes_;
  counts.recent_states = recent_states_written_;
  counts.checkpoint_time = std::chrono::nanoseconds(checkpoint_nanoseconds_);
  return counts;
}

bool Storage::admits_checkpoint() {
  const std::lock_guard lock(budget_mutex_);
  return !checkpoint_budget_.debt(clock_.now());
}

void Storage::count_checkpoint(std::chrono::duration<double> cost, std::size_t bytes) {
  VAT_CHECK(cost.count() >= 0);
  {
    const std::lock_guard lock(budget_mutex_);
    checkpoint_budget_.charge(static_cast<double>(bytes), clock_.now());
  }
  ++checkpoints_written_;
  checkpoint_bytes_ += bytes;
  checkpoint_nanoseconds_ += static_cast<std::uint64_t>(cost.count() * 1e9);
}

void Storage::remove_closed() {
  post([this] {
    for (const std::uint64_t closed : sessions_.remove_closed()) {
      states_.remove_session(id_of(closed));
    }
    std::vector<std::uint64_t> open;  // no checkpoint is written meanwhile: this thread writes them
    for (const StoredSession& session : sessions_.sessions()) open.push_back(session.number);
    checkpoints_.keep_only(open);
    recent_states_.keep_only(open);
  });
}

void Storage::wait_to_move() {
  move_timer_->start(clock_.now() + kMoveInterval, [this] {
    if (stopping_) return;
    run([this] { move_logs(); });
    wait_to_move();
  });
}

void Storage::move_logs() {
  move_log(sessions_);
  move_log(states_);
}

}  // namespace vat
