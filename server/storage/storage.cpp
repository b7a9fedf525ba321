#include "server/storage/storage.h"

#include <spdlog/spdlog.h>

#include <boost/asio/post.hpp>
#include <chrono>
#include <exception>
#include <future>
#include <utility>
#include <vector>

namespace vat {
namespace {

constexpr auto kMoveInterval = std::chrono::seconds(1);
// While commands keep coming the moved part of a log is not used again; beyond this they wait once,
// for some milliseconds, so that it is.
constexpr std::size_t kMostLogBytes = std::size_t{64} << 20;

template <class Store>
void move_log(Store& store) {
  if (store.move_log(false) > kMostLogBytes) store.move_log(true);
}

}  // namespace

Storage::Storage(const std::string& folder, const StorageLimits& limits)
    : folder_(folder),
      limits_(limits),
      sessions_(folder_.file("vat.db")),
      checkpoints_(folder_.file("checkpoints.db"), limits.checkpoint_bytes) {
  remove_closed();
  boost::asio::post(thread_, [this] { wait_to_move(); });
}

Storage::~Storage() {
  boost::asio::post(thread_, [this] { move_timer_.cancel(); });
  thread_.join();
}

void Storage::post(std::function<void()> task) {
  boost::asio::post(thread_, [this, task = std::move(task)] { run(task); });
}

void Storage::flush() {
  std::promise<void> done;
  boost::asio::post(thread_, [&done] { done.set_value(); });
  done.get_future().wait();
}

void Storage::run(const std::function<void()>& task) {
  try {
    task();
  } catch (const std::exception& error) {
    count_failure();
    spdlog::error("storage: {}", error.what());
  }
}

void Storage::remove_closed() {
  post([this] {
    sessions_.remove_closed();
    std::vector<std::uint64_t> open;  // checkpoints are written on this thread: none comes between
    for (const StoredSession& session : sessions_.sessions()) open.push_back(session.number);
    checkpoints_.keep_only(open);
  });
}

void Storage::wait_to_move() {
  move_timer_.expires_after(kMoveInterval);
  move_timer_.async_wait([this](const boost::system::error_code& failure) {
    if (failure) return;
    run([this] { move_logs(); });
    wait_to_move();
  });
}

void Storage::move_logs() {
  move_log(sessions_);
  move_log(checkpoints_);
}

}  // namespace vat
