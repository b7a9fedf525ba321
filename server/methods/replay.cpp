// recording.import, replay.*

#include "core/limits.h"
#include "server/methods/handlers.h"
#include "server/methods/parts.h"
#include "server/support/base64.h"

namespace vat {
namespace {

RpcError no_replay() {
  return not_allowed("the session is not a replay; replay.open creates one");
}

ActionResult seek(const SessionCore& core, std::optional<std::uint64_t> position,
                  std::uint64_t tick) {
  if (core.playback() == nullptr) return no_replay();
  if (position) return SeekTo{*position};
  if (const auto found = core.playback()->find_tick(core, tick)) return SeekTo{*found};
  return invalid_params({Error{"bad_value", "/tick",
                               "must be of the current run, which a reset or another scene "
                               "ends; use a position instead"}});
}

}  // namespace

ServerAction read_recording_import(ObjectReader& params, Errors& errors) {
  Imports::Chunk part;
  if (params.has("recording")) part.name = params.text("recording", kMaxTokenBytes);
  part.size = params.count("size", 1, kMaxRecordingBytes);
  part.offset = params.count("offset", 0, kMaxRecordingBytes);
  const std::string data = params.text("data", kMaxImportPart);
  if (auto bytes = from_base64(data)) {
    part.bytes = *std::move(bytes);
  } else {
    add_error(errors, "bad_value", params.path_of("data"), "must be base64, with padding");
  }
  return [part = std::move(part)](SessionDirectory& directory, PendingReply& reply) {
    return directory.replay_opener().import_recording(reply, part);
  };
}

ServerAction read_replay_open(ObjectReader& params, Errors& errors) {
  ReplaySource source;
  if (params.has("session")) source.session = read_session_id(params);
  if (params.has("recording")) source.recording = params.text("recording", kMaxTokenBytes);
  if (source.session.has_value() == source.recording.has_value()) {
    add_error(errors, "bad_value", params.path_of("session"),
              "give either a session or a recording");
  }
  if (params.has("name")) source.name = params.text("name", kMaxNameLength);
  return [source](SessionDirectory& directory, PendingReply& reply) -> std::optional<RpcResult> {
    if (auto error = directory.replay_opener().open(reply, source)) return *std::move(error);
    return {};
  };
}

SessionAction read_replay_info(ObjectReader&, Errors&) {
  return [](SessionCore& core, Participant&) -> ActionResult {
    if (core.playback() == nullptr) return no_replay();
    return core.playback()->describe(core);
  };
}

SessionAction read_replay_seek(ObjectReader& params, Errors& errors) {
  std::optional<std::uint64_t> position;
  std::uint64_t tick = 0;
  if (params.has("position")) position = params.count("position", 0, kMaxExactCount);
  if (params.has("tick")) tick = params.count("tick", 0, kMaxExactCount);
  if (params.has("position") == params.has("tick")) {
    add_error(errors, "bad_value", params.path_of("position"), "give either a position or a tick");
  }
  return [position, tick](SessionCore& core, Participant&) { return seek(core, position, tick); };
}

}  // namespace vat
