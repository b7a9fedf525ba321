#pragma once

#include <algorithm>
#include <boost/asio/post.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "server/support/clock.h"
#include "tests/support/patience.h"

namespace vat::test {

/// A clock that only tests advance.
class ManualClock final : public Clock {
 public:
  using Duration = SteadyClock::duration;

  SteadyClock::time_point now() const override {
    const std::lock_guard lock(mutex_);
    return now_;
  }
  double wall_time() const override {
    return 1.7e9 + std::chrono::duration<double>(now() - kStart).count();
  }
  std::unique_ptr<Timer> make_timer(boost::asio::any_io_executor executor) override {
    return std::make_unique<ManualTimer>(*this, std::move(executor));
  }

  /// Advances the time by `time`. Runs the due tasks in order, each at its time. Before and after,
  /// the timers' executors finish their queued work.
  void advance(Duration time) {
    const SteadyClock::time_point end = now() + time;
    settle();
    while (run_next(end)) settle();
    const std::lock_guard lock(mutex_);
    now_ = std::max(now_, end);
  }
  /// Advances to the next due task and runs it. Throws if no task is waiting.
  void advance_to_next() {
    settle();
    if (!run_next(SteadyClock::time_point::max())) {
      throw std::runtime_error("no timer is waiting: no event will come");
    }
    settle();
  }
  /// Advances the time by `time` and queues the due tasks without waiting for them.
  void expire(Duration time) {
    const SteadyClock::time_point end = now() + time;
    while (const auto due = take_next(end)) boost::asio::post(due->executor, due->task);
    const std::lock_guard lock(mutex_);
    now_ = std::max(now_, end);
  }
  /// Returns the number of tasks that have become due.
  std::size_t tasks_run() const {
    const std::lock_guard lock(mutex_);
    return tasks_run_;
  }
  /// Returns the number of waiting tasks.
  std::size_t waiting() const {
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(std::ranges::count_if(
        timers_, [](const auto& entry) { return entry.second.task != nullptr; }));
  }

 private:
  static constexpr SteadyClock::time_point kStart{std::chrono::hours(1000)};
  static constexpr std::chrono::seconds kPatience{60 * kSlowdown};

  struct Entry {
    boost::asio::any_io_executor executor;
    SteadyClock::time_point time{};
    std::uint64_t order = 0;  // order of tasks that are due at the same time
    std::function<void()> task;
  };

  class ManualTimer final : public Timer {
   public:
    ManualTimer(ManualClock& clock, boost::asio::any_io_executor executor) : clock_(clock) {
      const std::lock_guard lock(clock_.mutex_);
      clock_.timers_[this].executor = std::move(executor);
    }
    ~ManualTimer() override {
      ManualTimer::cancel();
      const std::lock_guard lock(clock_.mutex_);
      clock_.timers_.erase(this);
    }
    void start(SteadyClock::time_point time, std::function<void()> task) override {
      ManualTimer::cancel();
      const std::lock_guard lock(clock_.mutex_);
      Entry& entry = clock_.timers_.at(this);
      if (time <= clock_.now_) {
        boost::asio::post(entry.executor, std::move(task));
        return;
      }
      entry.time = time;
      entry.order = ++clock_.last_order_;
      entry.task = std::move(task);
    }
    void cancel() override {
      std::function<void()> dropped;  // destroyed without the mutex, since it may own other timers
      const std::lock_guard lock(clock_.mutex_);
      dropped.swap(clock_.timers_.at(this).task);
    }

   private:
    ManualClock& clock_;
  };

  /// Removes the first task due at `end` or before, and advances to its time.
  std::optional<Entry> take_next(SteadyClock::time_point end) {
    const std::lock_guard lock(mutex_);
    Entry* next = nullptr;
    for (auto& [timer, entry] : timers_) {
      if (entry.task == nullptr || entry.time > end) continue;
      if (next == nullptr ||
          std::pair(entry.time, entry.order) < std::pair(next->time, next->order)) {
        next = &entry;
      }
    }
    if (next == nullptr) return {};
    now_ = std::max(now_, next->time);
    Entry taken = *next;
    next->task = nullptr;
    ++tasks_run_;
    return taken;
  }
  bool run_next(SteadyClock::time_point end) {
    const auto due = take_next(end);
    if (due) run_on(due->executor, due->task);
    return due.has_value();
  }

  static void run_on(const boost::asio::any_io_executor& executor, std::function<void()> task) {
    const auto done = std::make_shared<std::promise<void>>();
    std::future<void> end = done->get_future();
    boost::asio::post(executor, [done, task = std::move(task)] {
      task();
      done->set_value();
    });
    if (end.wait_for(kPatience) != std::future_status::ready) {
      throw std::runtime_error("an executor of a timer does not finish its work");
    }
  }
  /// Runs twice, because work of one executor may queue work of another.
  void settle() {
    for (int pass = 0; pass < 2; ++pass) {
      for (const auto& executor : executors()) run_on(executor, [] {});
    }
  }
  std::vector<boost::asio::any_io_executor> executors() const {
    const std::lock_guard lock(mutex_);
    std::vector<boost::asio::any_io_executor> all;
    for (const auto& [timer, entry] : timers_) {
      if (std::ranges::find(all, entry.executor) == all.end()) all.push_back(entry.executor);
    }
    return all;
  }

  mutable std::mutex mutex_;
  SteadyClock::time_point now_ = kStart;
  std::map<const ManualTimer*, Entry> timers_;
  std::uint64_t last_order_ = 0;
  std::size_t tasks_run_ = 0;
};

}  // namespace vat::test
