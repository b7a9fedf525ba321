// Sessions that show recordings, and where these come from.

#include <spdlog/spdlog.h>

#include <boost/asio/post.hpp>
#include <exception>
#include <utility>

#include "core/limits.h"
#include "server/replay/foreign_text.h"
#include "server/replay/recorder.h"
#include "server/session/replay_run.h"
#include "server/session/scene_loading.h"
#include "server/session/session_directory.h"

namespace vat {
namespace {

RpcError refuse_recording(Errors errors) {
  for (Error& error : errors) error.path = "/data";
  return invalid_params(errors);
}

/// What it takes to run it, by the limits that hold for all.
std::optional<RpcError> find_excess(const Recording& recording) {
  if (recording.end - recording.begin > kMaxRecordedTicks) {
    return limit_reached("recording_ticks", kMaxRecordedTicks);
  }
  if (recording.log.size() > kMaxRecordedEntries) {
    return limit_reached("recording_entries", kMaxRecordedEntries);
  }
  return {};
}

}  // namespace

std::optional<RpcResult> SessionDirectory::import_recording(PendingReply& caller,
                                                            const Imports::Part& part) {
  auto added = imports_.add(caller.client()->id(), part, clock_.now());
  if (auto* error = std::get_if<RpcError>(&added)) return std::move(*error);
  const auto& progress = std::get<Imports::Progress>(added);
  if (!progress.is_whole) {
    return Json{{"recording", progress.name}, {"received", progress.received}, {"whole", false}};
  }
  boost::asio::post(creations_, [this, name = progress.name, size = progress.received,
                                 caller = std::move(caller)]() mutable {
    RpcResult result = internal_error();
    try {
      result = take_recording(name, size);
    } catch (const std::exception& error) {
      spdlog::warn("recording.import failed: {}", error.what());
    }
    if (std::holds_alternative<RpcError>(result)) imports_.forget(name);
    caller.answer(result);
  });
  return {};
}

RpcResult SessionDirectory::take_recording(const std::string& name, std::size_t size) {
  const auto bytes = imports_.take_bytes(name);
  if (!bytes) return not_allowed("the file was forgotten");
  Result<Recording> read = read_recording(*bytes);
  if (!read) return refuse_recording(read.errors());
  Recording content = std::move(read).value();
  // Anybody may have written it.
  content.name = fit_to_tell(content.name, kMaxNameLength);
  const auto recording = std::make_shared<const Recording>(std::move(content));
  if (auto error = find_excess(*recording)) return *std::move(error);
  try {
    ReplayPlayer(*recording, environment_).begin();
  } catch (const StorageError& error) {
    return refuse_recording({Error{"bad_value", "", error.what()}});
  }
  imports_.put(name, recording, clock_.now());
  return Json{{"recording", name},
              {"received", size},
              {"whole", true},
              {"name", recording->name},
              {"ticks", recording->end - recording->begin},
              {"instruction_set", to_string(recording->instructions)}};
}

std::optional<RpcError> SessionDirectory::open_replay(PendingReply& caller,
                                                      const ReplaySource& source) {
  const std::lock_guard lock(mutex_);
  const Client* client = find_caller(caller);
  if (client == nullptr) return not_allowed("the connection is closed");
  if (auto error = refuse_session_locked()) return error;
  if (auto error = refuse_source(caller, *client, source)) return error;
  if (replay_count() >= settings_.limits.max_replays) {
    return limit_reached("replays", settings_.limits.max_replays);
  }
  const std::size_t most = settings_.limits.max_sessions_per_address;
  SessionCreator creator{caller.client()->id(),
                         sessions_by_address_.take(caller.client()->address(), most)};
  if (creator.place == nullptr) return limit_reached("sessions_per_address", most);
  if (source.recording) {
    const auto recording = imports_.find(*source.recording, clock_.now());
    if (recording == nullptr) {
      return invalid_params({Error{"bad_value", "/recording", "none has this name any more"}});
    }
    boost::asio::post(creations_,
                      [this, recording, name = source.name, creator = std::move(creator),
                       caller = std::move(caller)]() mutable {
                        answer_replay(std::move(caller), recording, name, std::move(creator));
                      });
    return {};
  }
  record_and_open(caller, source, std::move(creator));
  return {};
}

std::optional<RpcError> SessionDirectory::refuse_source(const PendingReply& caller,
                                                        const Client& client,
                                                        const ReplaySource& source) {
  const MethodRules& rules = rules_of("replay.open");
  if (source.recording) {
    if (!client.access.session.empty()) {
      return not_allowed("the token is for session " + client.access.session + " only");
    }
    return vat::refuse_role(rules, client.access.role);
  }
  const auto session = find_session(*source.session);
  if (session == sessions_.end()) return refuse_missing(client, *source.session);
  if (auto error = refuse_access(client, session->first)) return error;
  if (auto error = refuse_role(caller, rules, session->first)) return error;
  if (session->first >= kFirstReplay) return not_allowed("the session is a replay itself");
  if (storage_ == nullptr) return not_allowed("the server keeps no sessions; see --data");
  return {};
}

void SessionDirectory::record_and_open(PendingReply& caller, const ReplaySource& source,
                                       SessionCreator creator) {
  const auto waiting = std::make_shared<PendingReply>(std::move(caller));
  const auto by = std::make_shared<SessionCreator>(std::move(creator));
  const auto session = find_session(*source.session)->second;
  session->keep_and(
      [this, waiting, by, name = source.name](Storage& storage, std::uint64_t number) {
        boost::asio::post(creations_, [this, waiting, by, name, &storage, number] {
          try {
            const std::size_t most = settings_.limits.max_recording_bytes;
            auto recording = record_session(storage, number, most);
            if (!recording) {
              waiting->answer(limit_reached("recording_bytes", most));
              return;
            }
            answer_replay(std::move(*waiting),
                          std::make_shared<const Recording>(*std::move(recording)), name,
                          std::move(*by));
          } catch (const StorageError& error) {
            spdlog::error("no replay of session s{}: {}", number, error.what());
            waiting->answer(storage_failed(error.kind()));
          } catch (const std::exception& error) {
            spdlog::error("no replay of session s{}: {}", number, error.what());
            waiting->answer(internal_error());
          }
        });
      },
      waiting);
}

void SessionDirectory::answer_replay(PendingReply caller,
                                     std::shared_ptr<const Recording> recording,
                                     const std::string& name, SessionCreator creator) {
  const ThreadPoolRunner::HelperReservation guest(runner_);
  try {
    caller.answer(make_replay(std::move(recording), name, std::move(creator)));
  } catch (const StorageError& error) {
    caller.answer(not_allowed(error.what()));
  } catch (const std::exception& error) {
    spdlog::error("replay.open failed: {}", error.what());
    caller.answer(internal_error());
  }
}

RpcResult SessionDirectory::make_replay(std::shared_ptr<const Recording> recording,
                                        const std::string& name, SessionCreator creator) {
  const std::uint64_t begin = recording->begin;
  const std::uint64_t end = recording->end;
  const std::string shown = name.empty() ? recording->name : name;
  auto replay = std::make_unique<ReplayRun>(std::move(recording), environment_);
  Simulation simulation = replay->begin();
  auto share = resources_.take(resources_of(simulation));
  if (const auto* excess = std::get_if<ResourceExcess>(&share)) return limit_reached(*excess);

  const std::lock_guard lock(mutex_);
  if (auto error = refuse_session_locked()) return *std::move(error);
  if (replay_count() >= settings_.limits.max_replays) {
    return limit_reached("replays", settings_.limits.max_replays);
  }
  const Sessions::key_type number = ++last_replay_;
  const auto session = std::make_shared<Session>(
      to_id(number), SessionSettings{shown, default_role(), false, creator.connection},
      std::move(simulation), std::get<ResourceShare>(std::move(share)), environment_, pool_,
      slow_tick_gate_);
  session->show(std::move(replay));
  sessions_.emplace(number, session);
  places_.emplace(number, std::move(creator.place));
  session->start();
  spdlog::info("session {} shows a recording of {}", to_id(number), shown);
  return Json{{"session", to_id(number)},
              {"tick", session->summary().tick},
              {"begin", begin},
              {"end", end}};
}

std::size_t SessionDirectory::replay_count() const {
  return static_cast<std::size_t>(
      std::distance(sessions_.lower_bound(kFirstReplay), sessions_.end()));
}

}  // namespace vat
