#include "server/session/session_archive.h"

#include <optional>
#include <vector>

#include "core/support/check.h"
#include "protocol/messages/describe.h"
#include "server/history/recorder.h"
#include "server/http/downloads.h"

namespace vat {

RpcResult export_recording(const SessionEnvironment& environment, const std::string& session,
                           Storage& storage, std::uint64_t number, std::uint64_t tick) {
  VAT_CHECK(environment.downloads != nullptr);
  const ServerLimits& limits = environment.limits;
  const std::size_t max_bytes = limits.max_recording_bytes;
  const std::optional<Recording> recording = record_session(storage, number, max_bytes);
  if (!recording) return limit_reached("recording_bytes", max_bytes);
  VAT_CHECK(recording->end >= recording->begin);
  const std::vector<std::uint8_t> bytes = write_recording(*recording);
  if (bytes.size() > max_bytes) return limit_reached("recording_bytes", max_bytes);
  const auto path = environment.downloads->add({session + ".vatrec", {bytes.begin(), bytes.end()}},
                                               environment.clock.now());
  if (!path) return limit_reached("download_bytes", limits.max_download_bytes);
  return Json{{"tick", tick},
              {"path", *path},
              {"bytes", bytes.size()},
              {"ticks", recording->end - recording->begin},
              {"expires", Downloads::kPatience.count()}};
}

RpcResult save_state(const SessionEnvironment& environment, const std::string& session,
                     const MomentToSave& moment, const std::string& name,
                     const std::string& saved_by) {
  VAT_CHECK(environment.states != nullptr);
  const SavedState state = make_saved_state(moment, name, saved_by, environment.clock.wall_time());
  const ServerLimits& limits = environment.limits;
  const auto excess =
      environment.states->write(session, state,
                                {limits.max_states_per_session, limits.max_state_bytes_per_session,
                                 limits.max_state_bytes_in_all});
  if (excess) return limit_reached(*excess);
  return Json{{"tick", moment.tick},
              {"name", name},
              {"hash", describe_hash(state.entry.hash)},
              {"bytes", state.entry.bytes}};
}

}  // namespace vat
