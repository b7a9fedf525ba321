// recording.import, replay.*

#include "core/limits.h"
#include "server/session/base64.h"
#include "server/session/method_parts.h"
#include "server/session/replay_run.h"

namespace vat {
namespace {

ServerAction read_import(ObjectReader& params, Errors& errors) {
  Imports::Part part;
  if (params.has("recording")) part.name = params.text("recording", kMaxTokenBytes);
  part.size = params.count("size", 1, kMaxRecordingBytes);
  part.offset = params.count("offset", 0, kMaxRecordingBytes);
  const std::string data = params.text("data", kMaxImportPart);
  if (auto bytes = from_base64(data)) {
    part.bytes = *std::move(bytes);
  } else {
    add_error(errors, "bad_value", params.path_of("data"), "must be base64, with padding");
  }
  return [part = std::move(part)](SessionDirectory& directory, PendingReply& caller) {
    return directory.import_recording(caller, part);
  };
}

ServerAction read_open(ObjectReader& params, Errors& errors) {
  SessionDirectory::ReplaySource source;
  if (params.has("session")) source.session = read_session_id(params);
  if (params.has("recording")) source.recording = params.text("recording", kMaxTokenBytes);
  if (source.session.has_value() == source.recording.has_value()) {
    add_error(errors, "bad_value", params.path_of("session"),
              "give either a session or a recording");
  }
  if (params.has("name")) source.name = params.text("name", kMaxNameLength);
  return [source](SessionDirectory& directory, PendingReply& caller) -> std::optional<RpcResult> {
    if (auto error = directory.open_replay(caller, source)) return *std::move(error);
    return {};
  };
}

RpcError no_replay() {
  return not_allowed("the session is no replay; replay.open makes one");
}

SessionAction read_replay_info(ObjectReader&, Errors&) {
  return [](SessionCore& core, Participant&) -> ActionResult {
    if (core.replay() == nullptr) return no_replay();
    return core.replay()->describe(core);
  };
}

ActionResult seek(const SessionCore& core, std::optional<std::uint64_t> position,
                  std::uint64_t tick) {
  if (core.replay() == nullptr) return no_replay();
  if (position) return SeekTo{*position};
  if (const auto found = core.replay()->find_tick(core, tick)) return SeekTo{*found};
  return invalid_params({Error{"bad_value", "/tick",
                               "must be of the present run, which a reset or another scene "
                               "ends; positions lead everywhere"}});
}

SessionAction read_seek(ObjectReader& params, Errors& errors) {
  std::optional<std::uint64_t> position;
  std::uint64_t tick = 0;
  if (params.has("position")) position = params.count("position", 0, kMaxExactCount);
  if (params.has("tick")) tick = params.count("tick", 0, kMaxExactCount);
  if (params.has("position") == params.has("tick")) {
    add_error(errors, "bad_value", params.path_of("position"), "give either a position or a tick");
  }
  return [position, tick](SessionCore& core, Participant&) { return seek(core, position, tick); };
}

constexpr Method kReplayMethods[] = {
    {"recording.import", read_import},
    {"replay.open", read_open},
    {"replay.info", read_replay_info},
    {"replay.seek", read_seek},
};

}  // namespace

std::span<const Method> replay_methods() {
  return kReplayMethods;
}

}  // namespace vat
