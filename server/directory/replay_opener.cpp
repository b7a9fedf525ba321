#include "server/directory/replay_opener.h"

#include <boost/asio/post.hpp>
#include <exception>
#include <utility>

#include "core/limits.h"
#include "core/support/check.h"
#include "server/history/recorder.h"
#include "server/replay/foreign_text.h"
#include "server/replay/replay_run.h"
#include "server/session/core/scene_loading.h"
#include "server/support/log.h"

namespace vat {
namespace {

RpcError refuse_recording(Errors errors) {
  for (Error& error : errors) error.path = "/data";
  return invalid_params(errors);
}

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

ReplayOpener::ReplayOpener(ServerResources& resources, DirectoryTables& tables,
                           Admission& admission, AccessControl& access)
    : resources_(resources), tables_(tables), admission_(admission), access_(access) {}

std::optional<RpcResult> ReplayOpener::import_recording(PendingReply& reply,
                                                        const Imports::Chunk& part) {
  auto added = resources_.imports.add(reply.client()->id(), part, resources_.clock.now());
  if (auto* error = std::get_if<RpcError>(&added)) return std::move(*error);
  const auto& progress = std::get<Imports::Progress>(added);
  if (!progress.is_whole) {
    return Json{{"recording", progress.name}, {"received", progress.received}, {"whole", false}};
  }
  boost::asio::post(resources_.creations, [this, name = progress.name, size = progress.received,
                                           reply = std::move(reply)]() mutable {
    RpcResult result = internal_error();
    try {
      result = read_import(name, size);
    } catch (const std::exception& error) {
      log_warning("recording.import failed: {}", error.what());
    }
    if (std::holds_alternative<RpcError>(result)) resources_.imports.forget(name);
    reply.answer(result);
  });
  return {};
}

RpcResult ReplayOpener::read_import(const std::string& name, std::size_t size) {
  const auto bytes = resources_.imports.take_bytes(name);
  if (!bytes) return not_allowed("the file has expired");
  Result<Recording> read = read_recording(*bytes);
  if (!read) return refuse_recording(read.errors());
  Recording content = std::move(read).value();
  content.name = fit_to_tell(content.name, kMaxNameLength);  // may contain any text
  const auto recording = std::make_shared<const Recording>(std::move(content));
  if (auto error = find_excess(*recording)) return *std::move(error);
  try {
    ReplayPlayer(*recording, resources_.environment).begin();
  } catch (const StorageError& error) {
    return refuse_recording({Error{"bad_value", "", error.what()}});
  }
  resources_.imports.put(name, recording, resources_.clock.now());
  return Json{{"recording", name},
              {"received", size},
              {"whole", true},
              {"name", recording->name},
              {"ticks", recording->end - recording->begin},
              {"instruction_set", to_string(recording->instructions)}};
}

std::optional<RpcError> ReplayOpener::open(PendingReply& reply, const ReplaySource& source) {
  VAT_CHECK(source.session.has_value() != source.recording.has_value());
  const std::lock_guard lock(tables_.mutex);
  const Client* client = tables_.clients.find(reply);
  if (client == nullptr) return not_allowed("the connection is closed");
  if (auto error = admission_.refuse_session()) return error;
  if (auto error = refuse_source(reply, *client, source)) return error;
  if (auto error = admission_.refuse_replay()) return error;
  auto admitted = admission_.admit_creator(reply);
  if (auto* error = std::get_if<RpcError>(&admitted)) return std::move(*error);
  auto& creator = std::get<SessionCreator>(admitted);
  if (source.session) {
    open_stored(reply, source, std::move(creator));
    return {};
  }
  const auto recording = resources_.imports.find(*source.recording, resources_.clock.now());
  if (recording == nullptr) {
    return invalid_params(
        {Error{"bad_value", "/recording", "must be an imported recording that has not expired"}});
  }
  boost::asio::post(resources_.creations,
                    [this, recording, name = source.name, creator = std::move(creator),
                     reply = std::move(reply)]() mutable {
                      open_recording(reply, recording, name, std::move(creator));
                    });
  return {};
}

std::optional<RpcError> ReplayOpener::refuse_source(const PendingReply& reply, const Client& client,
                                                    const ReplaySource& source) {
  if (source.recording) {
    if (!client.access.session.empty()) {
      return not_allowed("the token is for session " + client.access.session + " only");
    }
    return refuse_role(reply.method(), client.access.role);
  }
  const auto* session = tables_.sessions.find(*source.session);
  if (session == nullptr) return admission_.refuse_missing(client, *source.session);
  if (auto error = admission_.refuse_access(client, session->first)) return error;
  if (auto error = admission_.refuse_role(reply, session->first)) return error;
  if (session->first >= kFirstReplay) return not_allowed("the session is itself a replay");
  if (resources_.storage == nullptr) {
    return not_allowed("the server stores no sessions; see --data");
  }
  return {};
}

void ReplayOpener::open_stored(PendingReply& reply, const ReplaySource& source,
                               SessionCreator creator) {
  VAT_CHECK(tables_.mutex.is_held());
  const auto pending = std::make_shared<PendingReply>(std::move(reply));
  const auto by = std::make_shared<SessionCreator>(std::move(creator));
  const auto* session = tables_.sessions.find(*source.session);
  VAT_CHECK(session != nullptr);
  session->second->store_then(
      [this, pending, by, name = source.name](Storage& storage, SessionNumber number) {
        boost::asio::post(resources_.creations, [this, pending, by, name, &storage, number] {
          std::shared_ptr<const Recording> recording;
          try {
            const std::size_t maximum = resources_.settings.limits.max_recording_bytes;
            if (auto made = record_session(storage, number, maximum)) {
              recording = std::make_shared<const Recording>(*std::move(made));
            }
          } catch (const StorageError& error) {
            log_error("no replay of session {}: {}", to_id(number), error.what());
            return pending->answer(storage_failed(error.kind()));
          } catch (const std::exception& error) {
            log_error("no replay of session {}: {}", to_id(number), error.what());
            return pending->answer(internal_error());
          }
          if (recording == nullptr) {
            const std::size_t maximum = resources_.settings.limits.max_recording_bytes;
            return pending->answer(limit_reached("recording_bytes", maximum));
          }
          open_recording(*pending, recording, name, std::move(*by));
        });
      },
      pending);
}

void ReplayOpener::open_recording(PendingReply& reply, std::shared_ptr<const Recording> recording,
                                  const std::string& name, SessionCreator creator) {
  try {
    access_.answer_created(reply, make_replay(std::move(recording), name, std::move(creator)));
  } catch (const StorageError& error) {
    reply.answer(not_allowed(error.what()));
  } catch (const NatsError& error) {
    log_error("replay.open failed: {}", error.what());
    reply.answer(storage_failed(StorageError::Kind::unreachable));
  } catch (const std::exception& error) {
    log_error("replay.open failed: {}", error.what());
    reply.answer(internal_error());
  }
}

RpcResult ReplayOpener::make_replay(std::shared_ptr<const Recording> recording,
                                    const std::string& name, SessionCreator creator) {
  const ThreadPoolRunner::HelperReservation reservation(resources_.runner);
  const std::uint64_t begin = recording->begin;
  const std::uint64_t end = recording->end;
  VAT_CHECK(begin <= end);
  const std::string shown = name.empty() ? recording->name : name;
  auto replay = std::make_unique<ReplayRun>(std::move(recording), resources_.environment);
  Simulation simulation = replay->begin();
  auto share = resources_.budget.take(resources_of(simulation));
  if (const auto* excess = std::get_if<LimitExcess>(&share)) return limit_reached(*excess);

  ClusterNode* const cluster = resources_.cluster.get();
  const SessionNumber in_cluster = cluster == nullptr ? 0 : kFirstReplay + cluster->new_number();

  const std::lock_guard lock(tables_.mutex);
  if (auto error = admission_.refuse_session()) return *std::move(error);
  if (auto error = admission_.refuse_replay()) return *std::move(error);
  const SessionNumber number =
      cluster == nullptr ? tables_.sessions.next_replay_number() : in_cluster;
  auto core = std::make_unique<SessionCore>(
      to_id(number), SessionSettings{shown, admission_.default_role(), false, creator.connection},
      std::move(simulation), std::get<ResourceShare>(std::move(share)), resources_.environment);
  replay->start(*core);
  const auto session = std::make_shared<Session>(std::move(core), std::move(replay),
                                                 resources_.pool, resources_.slow_tick_gate);
  tables_.sessions.add(number, session, std::move(creator.place));
  session->start();
  log_info("session {} shows a recording of {}", to_id(number), shown);
  return Json{{"session", to_id(number)},
              {"tick", session->summary().tick},
              {"begin", begin},
              {"end", end}};
}

}  // namespace vat
