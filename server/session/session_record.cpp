// How a session becomes a recording.

#include <spdlog/spdlog.h>

#include <boost/asio/post.hpp>
#include <exception>
#include <memory>
#include <utility>

#include "server/http/downloads.h"
#include "server/replay/recorder.h"
#include "server/session/session.h"

namespace vat {
namespace {

RpcResult make_recording(Storage& storage, std::uint64_t number, const std::string& id,
                         Downloads& downloads, const ServerLimits& limits, const Clock& clock) {
  const std::size_t most = limits.max_recording_bytes;
  const std::optional<Recording> recording = record_session(storage, number, most);
  if (!recording) return limit_reached("recording_bytes", most);
  const std::vector<std::uint8_t> bytes = write_recording(*recording);
  if (bytes.size() > most) return limit_reached("recording_bytes", most);
  const auto path = downloads.add({id + ".vatrec", {bytes.begin(), bytes.end()}}, clock.now());
  if (!path) return limit_reached("download_bytes", limits.max_download_bytes);
  return Json{{"path", *path},
              {"bytes", bytes.size()},
              {"ticks", recording->end - recording->begin},
              {"expires", Downloads::kPatience.count()}};
}

}  // namespace

void Session::record(PendingReply caller) {
  const auto waiting = std::make_shared<PendingReply>(std::move(caller));
  Downloads* const downloads = core_.environment().downloads;
  if (downloads == nullptr) {
    waiting->answer(not_allowed("nobody could fetch it"));
    return;
  }
  // On the pool once it is written: the storage's thread has other sessions to keep.
  const auto make = [self = shared_from_this(), waiting, downloads](Storage& storage,
                                                                    std::uint64_t number) {
    boost::asio::post(
        self->strand_.get_inner_executor(), [self, waiting, downloads, &storage, number] {
          try {
            RpcResult result =
                make_recording(storage, number, self->id_, *downloads,
                               self->core_.environment().limits, self->core_.environment().clock);
            if (auto* json = std::get_if<Json>(&result)) (*json)["tick"] = self->summary().tick;
            waiting->answer(result);
          } catch (const StorageError& error) {
            spdlog::error("session {}: no recording: {}", self->id_, error.what());
            waiting->answer(storage_failed(error.kind()));
          } catch (const std::exception& error) {
            spdlog::error("session {}: no recording: {}", self->id_, error.what());
            waiting->answer(internal_error());
          }
        });
  };
  core_.log()->keep_and(core_.moment(), core_.environment().clock.now(), make);
}

}  // namespace vat
