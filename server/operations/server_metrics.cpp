#include "server/operations/server_metrics.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "protocol/files/text.h"

namespace vat {
namespace {

/// Close codes of PROTOCOL.md. Others are counted together, because clients may send any code.
constexpr std::uint16_t kCloseCodes[] = {1000, 1001, 1002, 1005, 1006, 1007, 1009, 1011,
                                         1013, 4001, 4003, 4008, 4009, 4010, 4012};

void append_head(std::string& text, const char* name, const char* type, const char* help) {
  text += std::string("# HELP ") + name + ' ' + help + "\n# TYPE " + name + ' ' + type + '\n';
}

/// `labels` without braces; empty for none.
template <class Number>
void append_sample(std::string& text, std::string_view name, std::string_view labels,
                   Number value) {
  text += name;
  if (!labels.empty()) (text += '{').append(labels) += '}';
  text += ' ';
  append_number(text, value);
  text += '\n';
}

std::string label(std::string_view key, std::string_view value) {
  return std::string(key) + "=\"" + std::string(value) + '"';
}

void append_gauge(std::string& text, const char* name, const char* help, std::size_t value) {
  append_head(text, name, "gauge", help);
  append_sample(text, name, "", value);
}

void append_counter(std::string& text, const char* name, const char* help, std::uint64_t value) {
  append_head(text, name, "counter", help);
  append_sample(text, name, "", value);
}

void append_memory(std::string& text, const ServerMetrics::Memory& memory) {
  append_gauge(text, "vat_process_memory_bytes", "Memory of the process, including swapped pages.",
               memory.process);
  append_gauge(text, "vat_max_memory_bytes",
               "Memory of the process above which new work is rejected; 0: no limit.",
               memory.maximum);
  append_gauge(text, "vat_heap_bytes", "Memory in use, without freed memory.", memory.heap);
  append_head(text, "vat_memory_bytes", "gauge", "Memory in use by purpose, partly estimated.");
  for (const auto& [use, bytes] : memory.uses) {
    append_sample(text, "vat_memory_bytes", label("use", use), bytes);
  }
}

void append_present(std::string& text, const ServerMetrics::Gauges& now) {
  append_head(text, "vat_build_info", "gauge", "Version, and instruction set of all sessions.");
  append_sample(
      text, "vat_build_info",
      label("version", now.version) + ',' + label("instruction_set", to_string(now.instructions)),
      1);
  append_gauge(text, "vat_threads", "Threads that compute sessions.", now.threads);
  append_head(text, "vat_sessions", "gauge", "Sessions by state.");
  append_sample(text, "vat_sessions", label("state", "playing"), now.playing_sessions);
  append_sample(text, "vat_sessions", label("state", "paused"), now.paused_sessions);
  append_sample(text, "vat_sessions", label("state", "hibernating"), now.hibernating_sessions);
  append_gauge(text, "vat_abandoned_sessions",
               "Sessions without participants whose creator has disconnected.",
               now.abandoned_sessions);
  append_gauge(text, "vat_connections", "Open WebSockets.", now.connections);
  append_gauge(text, "vat_clients", "Connections that have joined a session.", now.clients);
  append_gauge(text, "vat_particles", "Particles of all sessions.", now.particles);
  append_memory(text, now.memory);
  append_counter(text, "vat_storage_failures_total", "Failed writes to the data folder.",
                 now.storage.failures);
  append_gauge(text, "vat_storage_failing", "1 if the last write to the journal failed.",
               now.storage.failing ? 1 : 0);
  append_counter(text, "vat_journal_writes_total", "Completed writes to the journal.",
                 now.storage.journal_writes);
  append_counter(text, "vat_journal_commits_total", "Transactions of the journal.",
                 now.storage.journal_commits);
  append_head(text, "vat_journal_commit_seconds_total", "counter",
              "Time of the transactions of the journal.");
  append_sample(text, "vat_journal_commit_seconds_total", "", now.storage.commit_time.count());
  append_counter(text, "vat_checkpoints_total", "Written checkpoints of sessions.",
                 now.storage.checkpoints);
  append_counter(text, "vat_checkpoint_bytes_total", "Size of these checkpoints.",
                 now.storage.checkpoint_bytes);
  append_counter(text, "vat_recent_states_total", "Written states that are not synchronised.",
                 now.storage.recent_states);
  append_head(text, "vat_checkpoint_seconds_total", "counter",
              "Processor time of the writing of checkpoints.");
  append_sample(text, "vat_checkpoint_seconds_total", "", now.storage.checkpoint_time.count());
}

}  // namespace

void ServerMetrics::add_tick(const Tick& tick) {
  const std::lock_guard lock(mutex_);
  const auto bound =
      std::ranges::lower_bound(kTickBounds, tick.time.count(), {}, &TickBound::seconds);
  ++ticks_[static_cast<std::size_t>(bound - kTickBounds.begin())];
  tick_seconds_ += tick.time.count();
  recent_ticks_.add(tick.time.count());
  substeps_ += tick.substeps;
  undone_substeps_ += tick.undone_substeps;
  for (const StageClock::Stage& stage : tick.stages) {
    StageTotal& total = stages_[stage.name];
    total.calls += stage.calls;
    total.seconds += stage.seconds();
  }
}

void ServerMetrics::add_lateness(std::chrono::duration<double> lateness) {
  const std::lock_guard lock(mutex_);
  recent_lateness_.add(lateness.count());
}

void ServerMetrics::add_encoded_frame(std::chrono::duration<double> time, bool is_key) {
  const std::lock_guard lock(mutex_);
  ++encoded_frames_;
  encoded_keys_ += is_key ? 1 : 0;
  encode_seconds_ += time.count();
}

void ServerMetrics::add_frame_groups(std::size_t count) {
  const std::lock_guard lock(mutex_);
  ++shown_states_;
  frame_groups_ += count;
}

void ServerMetrics::add_sent_frames(std::size_t count, std::size_t bytes_each) {
  const std::lock_guard lock(mutex_);
  sent_frames_ += count;
  sent_bytes_ += count * bytes_each;
}

void ServerMetrics::add_missed_frames(std::size_t count) {
  const std::lock_guard lock(mutex_);
  missed_frames_ += count;
}

void ServerMetrics::add_refusal(std::string_view limit) {
  const std::lock_guard lock(mutex_);
  ++refusals_[std::string(limit)];
}

void ServerMetrics::add_rate_limited(std::string_view limit) {
  const std::lock_guard lock(mutex_);
  ++rate_limited_[std::string(limit)];
}

void ServerMetrics::add_close(std::uint16_t code) {
  const bool is_ours = std::ranges::find(kCloseCodes, code) != std::end(kCloseCodes);
  const std::lock_guard lock(mutex_);
  ++closes_[is_ours ? code : 0];
}

std::string ServerMetrics::to_text(const Gauges& gauges) const {
  std::string text;
  append_present(text, gauges);
  const std::lock_guard lock(mutex_);
  append_ticks(text);
  append_recent_ticks(text);
  append_counter(text, "vat_substeps_total",
                 "Executed steps, including parts of steps and undone steps.", substeps_);
  append_counter(text, "vat_undone_substeps_total",
                 "Steps that the guard has undone and repeated with shorter steps.",
                 undone_substeps_);
  append_stages(text);
  append_frames(text);
  append_refusals(text);
  return text;
}

void ServerMetrics::append_ticks(std::string& text) const {
  constexpr const char* kName = "vat_tick_duration_seconds";
  const std::string bucket = std::string(kName) + "_bucket";
  append_head(text, kName, "histogram", "Wall time of the steps of a tick.");
  std::uint64_t count = 0;
  for (std::size_t b = 0; b < kTickBounds.size(); ++b) {
    count += ticks_[b];
    append_sample(text, bucket, label("le", kTickBounds[b].text), count);
  }
  count += ticks_.back();
  append_sample(text, bucket, label("le", "+Inf"), count);
  append_sample(text, std::string(kName) + "_sum", "", tick_seconds_);
  append_sample(text, std::string(kName) + "_count", "", count);
}

void ServerMetrics::append_frames(std::string& text) const {
  append_counter(text, "vat_states_shown_total", "States that at least one client could receive.",
                 shown_states_);
  append_counter(text, "vat_frame_groups_total",
                 "Different frames for these states; the clients of a group share a frame.",
                 frame_groups_);
  append_counter(text, "vat_frames_encoded_total", "Encoded frames.", encoded_frames_);
  append_counter(text, "vat_key_frames_encoded_total", "Encoded key frames.", encoded_keys_);
  append_head(text, "vat_frame_encode_seconds_total", "counter", "Wall time of the encoding.");
  append_sample(text, "vat_frame_encode_seconds_total", "", encode_seconds_);
  append_counter(text, "vat_frames_sent_total", "Sent frames, counted for each client.",
                 sent_frames_);
  append_counter(text, "vat_frame_bytes_sent_total", "Their bytes.", sent_bytes_);
  append_counter(text, "vat_frames_missed_total", "Frames that were due to a client but not sent.",
                 missed_frames_);
}

void ServerMetrics::append_refusals(std::string& text) const {
  append_head(text, "vat_refused_total", "counter",
              "Rejections, by the name of the limit in server.info.");
  for (const auto& [limit, count] : refusals_) {
    append_sample(text, "vat_refused_total", label("limit", limit), count);
  }
  append_head(text, "vat_rate_limited_total", "counter",
              "Messages rejected by a rate limit, by the name of the limit.");
  for (const auto& [limit, count] : rate_limited_) {
    append_sample(text, "vat_rate_limited_total", label("limit", limit), count);
  }
  append_head(text, "vat_connections_closed_total", "counter",
              "Closed WebSockets by close code; 1006: without a code.");
  for (const auto& [code, count] : closes_) {
    append_sample(text, "vat_connections_closed_total",
                  label("code", code == 0 ? "other" : std::to_string(code)), count);
  }
}

void ServerMetrics::append_recent_ticks(std::string& text) const {
  const auto append = [&](const char* name, const char* help, const RecentValues& values) {
    append_head(text, name, "gauge", help);
    for (const auto& [share, name_of_share] : {std::pair(0.5, "0.5"), std::pair(0.99, "0.99")}) {
      append_sample(text, name, label("quantile", name_of_share), values.quantile(share));
    }
  };
  append("vat_recent_tick_seconds", "Wall time of the last 512 ticks.", recent_ticks_);
  append("vat_recent_tick_lateness_seconds",
         "Start delay of the last 512 ticks of playing sessions.", recent_lateness_);
}

void ServerMetrics::append_stages(std::string& text) const {
  append_head(
      text, "vat_stage_seconds_total", "counter",
      "Wall time of each stage of steps; if ticks are short, only some ticks are measured.");
  for (const auto& [stage, total] : stages_) {
    append_sample(text, "vat_stage_seconds_total", label("stage", stage), total.seconds);
  }
  append_head(text, "vat_stage_calls_total", "counter",
              "Calls of each stage of steps; if ticks are short, only some ticks are counted.");
  for (const auto& [stage, total] : stages_) {
    append_sample(text, "vat_stage_calls_total", label("stage", stage), total.calls);
  }
}

}  // namespace vat
