#include "tests/bench/codec/codec.h"

#include <cmath>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "server/cli/common/command.h"
#include "tests/bench/codec/decode_times.h"
#include "tests/bench/codec/many.h"
#include "tests/bench/codec/measure.h"
#include "tests/bench/codec/peers.h"
#include "tests/bench/options.h"
#include "tests/bench/report/quantile.h"
#include "tests/bench/report/table.h"
#include "tests/bench/speed/machine.h"
#include "tests/bench/speed/targets.h"

namespace vat::bench {
namespace {

constexpr Real kFloatBits = 96;  // three float32
constexpr Real kNanosecond = 1e-9;

struct CodecOptions : Options {
  bool times_web = true;  ///< also times the TypeScript decoder
};

struct CodecRow {
  std::string scene;
  CodecSetting setting;
  CodecResult result;
};

struct PeerRow {
  std::string scene;
  Real share = 0;
  PeerResult result;
};

struct DecoderRow {
  std::string scene;
  std::size_t particles = 0;
  DecodeTimes times;
};

struct ManyRow {
  std::string scene;
  ManyResult result;
};

struct Results {
  std::vector<CodecRow> rows;
  std::vector<DecoderRow> decoders;
  std::vector<PeerRow> peers;
  std::vector<ManyRow> many;
};

std::vector<CodecSetting> settings_of(Real share) {
  std::vector<CodecSetting> settings{{share}};
  if (share != 64) return settings;
  for (const Real dropped : {0.1, 0.3}) settings.push_back({share, dropped});
  for (std::uint8_t detail = kFullDetail; detail-- > 0;) settings.push_back({share, 0, detail});
  return settings;
}

void measure_decoders(const CodecScene& scene, const std::vector<GridFrame>& frames,
                      std::size_t particles, const CodecOptions& options, Results& results) {
  const std::vector<FrameBytes> stream = stream_of(frames);
  results.decoders.push_back({scene.name, particles, time_decoder(stream)});
  if (!options.times_web) return;
  Result<std::vector<DecodeTimes>> web = time_web_decoder(stream, options.output, scene.name);
  if (!web) throw std::runtime_error(web.errors().front().message);
  for (DecodeTimes& times : web.value()) {
    results.decoders.push_back({scene.name, particles, std::move(times)});
  }
}

void measure_scene(const CodecScene& scene, const CodecOptions& options, Results& results) {
  const Recording recording = record(scene, options.threads);
  if (scene.is_large) {
    for (const ManyResult& each : measure_many(recording, scene.spacing / 64)) {
      results.many.push_back({scene.name, each});
    }
    return;
  }
  for (const Real share : {16, 64, 256}) {
    const std::vector<GridFrame> frames = on_grids(recording, scene.spacing / share);
    if (share == 64) {
      measure_decoders(scene, frames, recording.particles, options, results);
    }
    for (const CodecSetting& setting : settings_of(share)) {
      results.rows.push_back({scene.name, setting, measure_codec(recording, frames, setting)});
    }
    for (PeerResult& peer : measure_peers(frames)) {
      results.peers.push_back({scene.name, share, std::move(peer)});
    }
  }
}

Real nanoseconds(Real seconds, std::size_t particles) {
  return seconds / kNanosecond / static_cast<Real>(particles);
}

std::string error_name(Real share) {
  return "1/" + short_text(share);
}

Table to_table(const std::vector<CodecRow>& rows) {
  const Machine machine = this_machine();
  Table table{{"case", "greatest error [spacings]", "dropped", "detail", "particles", "frames",
               "bits per particle", "float32 over that", "kbit/s", "key bits per particle",
               "encode [ns]", "decode [ns]", "encode key [ns]", "decode key [ns]",
               "greatest error found [allowed]", "commit", "cpu"},
              {}};
  for (const auto& [scene, setting, r] : rows) {
    const Real bits = r.bits(r.delta_bytes);
    table.rows.push_back(
        {scene, error_name(setting.share), setting.dropped, std::uint64_t{setting.detail},
         std::uint64_t{r.particles}, std::uint64_t{r.delta_frames}, bits, kFloatBits / bits,
         8e-3 * kFrameRate * r.delta_bytes, r.bits(r.key_bytes), nanoseconds(r.encode, r.particles),
         nanoseconds(r.decode, r.particles), nanoseconds(r.encode_key, r.particles),
         nanoseconds(r.decode_key, r.particles), r.worst_error, machine.commit, machine.cpu});
  }
  return table;
}

Table to_table(const std::vector<PeerRow>& rows) {
  Table table{{"case", "greatest error [spacings]", "codec", "what", "bits per particle",
               "encode [ns]", "decode [ns]"},
              {}};
  for (const PeerRow& row : rows) {
    const PeerResult& r = row.result;
    const auto there = [&](Real value) { return r.is_built_in ? value : kAbsent; };
    table.rows.push_back({row.scene, error_name(row.share), r.name, r.what, there(r.bits),
                          there(r.encode / kNanosecond), there(r.decode / kNanosecond)});
  }
  return table;
}

constexpr Real kMillisecond = 1e-3;

Table to_table(const std::vector<DecoderRow>& rows) {
  const Machine machine = this_machine();
  Table table{
      {"case", "decoder", "version", "particles", "times", "ms per frame", "ms per frame, 90 %",
       "decode [ns]", "ms per key frame", "decode key [ns]", "commit", "cpu"},
      {}};
  for (const auto& [scene, particles, times] : rows) {
    const Real delta = median(times.deltas);
    const Real key = median(times.keys);
    table.rows.push_back({scene, times.decoder, times.version, std::uint64_t{particles},
                          std::uint64_t{times.deltas.size()}, delta / kMillisecond,
                          quantile(times.deltas, 0.9) / kMillisecond, nanoseconds(delta, particles),
                          key / kMillisecond, nanoseconds(key, particles), machine.commit,
                          machine.cpu});
  }
  return table;
}

Table to_table(const std::vector<ManyRow>& rows) {
  const Machine machine = this_machine();
  Table table{{"case", "detail", "particles", "bits per particle", "kbit/s", "quantise [ms]",
               "encode [ms]", "sum [ms]", "decode [ms]", "commit", "cpu"},
              {}};
  for (const auto& [scene, r] : rows) {
    const Real sum = r.quantise + r.encode;
    table.rows.push_back({scene, std::uint64_t{r.detail}, std::uint64_t{r.particles},
                          8 * r.bytes / static_cast<Real>(r.particles), 8e-3 * kFrameRate * r.bytes,
                          r.quantise / kMillisecond, r.encode / kMillisecond, sum / kMillisecond,
                          r.decode / kMillisecond, machine.commit, machine.cpu});
  }
  return table;
}

const CodecResult* find(const Results& results, const std::string& scene,
                        const CodecSetting& setting) {
  for (const CodecRow& row : results.rows) {
    if (row.scene == scene && row.setting.share == setting.share &&
        row.setting.dropped == setting.dropped && row.setting.detail == setting.detail) {
      return &row.result;
    }
  }
  return nullptr;
}

/// Adds the targets of these frames, if they were measured.
void add_bits(const Results& results, const std::string& scene, const CodecSetting& setting,
              const std::string& what, Real limit, std::vector<Target>& targets) {
  const CodecResult* result = find(results, scene, setting);
  if (result == nullptr) return;
  targets.push_back({scene + ": " + what, limit, false, result->bits(result->delta_bytes)});
}

void add_dam_break(const Results& results, const std::string& scene, std::vector<Target>& targets) {
  add_bits(results, scene, {64}, "bits per particle, error 1/64 of the spacing", 7.6, targets);
  add_bits(results, scene, {64, 0.3}, "the same with 30 % dropped", 8.6, targets);
  add_bits(results, scene, {16}, "bits per particle, error 1/16", 5.1, targets);
  const CodecResult* result = find(results, scene, {64});
  if (result == nullptr) return;
  targets.push_back(
      {scene + ": bits per particle of key frames", 26, false, result->bits(result->key_bytes)});
  targets.push_back({scene + ": encode [ns per particle]", 70, false,
                     nanoseconds(result->encode, result->particles)});
  targets.push_back({scene + ": decode [ns per particle]", 60, false,
                     nanoseconds(result->decode, result->particles)});
}

void add_rate(const Results& results, const std::string& scene, Real limit,
              std::vector<Target>& targets) {
  const CodecResult* result = find(results, scene, {64});
  if (result == nullptr) return;
  targets.push_back({scene + ": kbit/s at 30 frames a second", limit, false,
                     8e-3 * kFrameRate * result->delta_bytes});
}

/// Adds the time of a frame of 30 000 particles, from the time per particle.
void add_web_decoders(const Results& results, std::vector<Target>& targets) {
  constexpr Real kParticles = 30'000;
  for (const auto& [scene, particles, times] : results.decoders) {
    if (scene != "dam-break-30k" || times.decoder == "C++") continue;
    const bool is_browser = times.decoder.find("worker") != std::string::npos;
    const Real scale = kParticles / static_cast<Real>(particles) / kMillisecond;
    targets.push_back({scene + ": " + times.decoder + ", decode [ms per 30 000 particles]",
                       is_browser ? 5.0 : 3.0, false, scale * median(times.deltas)});
  }
}

std::vector<Target> targets_of(const Results& results) {
  std::vector<Target> targets;
  for (const char* scene : {"dam-break-10k", "dam-break-30k", "dam-break-30k-incompressible"}) {
    add_dam_break(results, scene, targets);
  }
  add_bits(results, "pool-settled", {64}, "bits per particle", 3.2, targets);
  add_bits(results, "pool-asleep", {64}, "bits per particle", 0.1, targets);
  add_rate(results, "figure-2", 600, targets);
  add_rate(results, "figure-2-settled", 25, targets);
  add_rate(results, "figure-2-asleep", 25, targets);
  add_web_decoders(results, targets);
  return targets;
}

Status write_codec_results(const Results& results, const std::string& folder) {
  const std::vector<Target> targets = targets_of(results);
  const Table table = to_table(results.rows);
  if (Status written = write_table(table, folder, "codec", "# Frames"); !written) return written;
  const Table decoders = to_table(results.decoders);
  if (Status written = write_table(decoders, folder, "decoders", "# Decoders"); !written) {
    return written;
  }
  if (Status written = write_table(to_table(results.peers), folder, "peers", "# Other codecs");
      !written) {
    return written;
  }
  const Table many = to_table(results.many);
  if (Status written = write_table(many, folder, "details", "# Levels of detail"); !written) {
    return written;
  }
  if (Status written = write_table(target_table(targets), folder, "targets", "# Targets");
      !written) {
    return written;
  }
  std::cout << '\n'
            << to_markdown(table) << '\n'
            << to_markdown(decoders) << '\n'
            << to_markdown(to_table(results.peers)) << '\n'
            << to_markdown(many) << '\n'
            << to_markdown(target_table(targets)) << "\nwritten to " << folder << '\n';
  return {};
}

int codec(CodecOptions options) {
  const std::vector<CodecScene> scenes = codec_scenes(options.quick);
  std::vector<std::string> names;
  for (const CodecScene& scene : scenes) names.push_back(scene.name);
  if (options.list) {
    print_names(names);
    return kExitOk;
  }
  Result<std::vector<std::size_t>> chosen = choose(options.cases, names);
  if (!chosen) return fail("codec", chosen.errors());
  if (options.cases.empty()) {
    std::erase_if(chosen.value(), [&](std::size_t index) { return scenes[index].is_large; });
  }
  Results results;
  if (const std::string why = no_web_decoder(); options.times_web && !why.empty()) {
    std::cout << "no times of the decoder in TypeScript: " << why << '\n';
    options.times_web = false;
  }
  try {
    for (const std::size_t index : chosen.value()) {
      std::cout << names[index] << " ..." << std::endl;
      measure_scene(scenes[index], options, results);
    }
  } catch (const std::runtime_error& error) {
    std::cerr << "codec: " << error.what() << '\n';
    return kExitFailed;
  }
  const Status written = write_codec_results(results, options.output);
  return written ? kExitOk : fail(options.output, written.errors());
}

}  // namespace

void add_codec_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("codec", "Size and coding time of frames");
  const auto options = std::make_shared<CodecOptions>();
  add_options(*command, *options);
  command->add_flag("!--no-web", options->times_web, "Do not time the decoder in TypeScript");
  command->footer(
      "Exit codes: 0 measured, 1 a run failed or a decoded frame differs, 2 wrong "
      "usage.");
  command->callback([options, &exit_code] { exit_code = codec(*options); });
}

}  // namespace vat::bench
