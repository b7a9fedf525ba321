#include "server/directory/server_resources.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <thread>
#include <utility>

#include "core/support/check.h"

namespace vat {
namespace {

// At least two: the system then shares even a single core between a slow tick and a fast one.
std::size_t thread_count(std::size_t wanted) {
  if (wanted > 0) return wanted;
  return std::max<std::size_t>(2, std::thread::hardware_concurrency());
}

ServerLimits without_scene_limits(ServerLimits limits) {
  limits.max_springs = limits.max_particles = limits.max_particle_steps_per_tick =
      limits.max_grabs_per_client = std::numeric_limits<std::size_t>::max();
  return limits;
}

std::unique_ptr<Storage> open_storage(const ServerSettings& settings, Clock& clock) {
  if (settings.data_folder.empty()) return nullptr;
  return std::make_unique<Storage>(settings.data_folder, settings.storage, clock);
}

std::unique_ptr<ClusterNode> make_cluster_node(const ServerSettings& settings, Storage* storage,
                                               Clock& clock, std::size_t threads) {
  if (!settings.cluster.is_used()) return nullptr;
  VAT_CHECK(storage != nullptr);
  return std::make_unique<ClusterNode>(settings.cluster, *storage, clock,
                                       static_cast<double>(threads), settings.version);
}

std::unique_ptr<RelayDoor> make_relay_door(const ServerSettings& settings, ClusterNode* cluster,
                                           ServerMetrics& metrics,
                                           boost::asio::thread_pool& frame_threads,
                                           const Clock& clock) {
  if (cluster == nullptr || !settings.cluster.is_relay()) return nullptr;
  return std::make_unique<RelayDoor>(
      RelayDoor::Place{cluster->name(), cluster->instance(), cluster->public_url()},
      cluster->relay_connection(), metrics, frame_threads, clock);
}

}  // namespace

SessionId to_id(SessionNumber number) {
  if (number >= kFirstReplay) return "r" + std::to_string(number - kFirstReplay);
  return "s" + std::to_string(number);
}

std::optional<SessionNumber> number_of(const SessionId& id) {
  SessionNumber number = 0;
  const char* const end = id.data() + id.size();
  const bool is_replay = id.starts_with('r');
  if (!is_replay && !id.starts_with('s')) return {};
  const auto [rest, error] = std::from_chars(id.data() + 1, end, number);
  if (error != std::errc() || rest != end || number >= kFirstReplay) return {};
  return is_replay ? kFirstReplay + number : number;
}

SavedStates* ServerResources::saved_states() const {
  if (cluster) return &cluster->saved_states();
  return storage ? &storage->states() : &saved_in_memory->states;
}

SavedScenes* ServerResources::saved_scenes() const {
  if (cluster) return &cluster->saved_scenes();
  return storage ? &storage->scenes() : &saved_in_memory->scenes;
}

ServerResources::ServerResources(const Catalogue& catalogue_in, ServerSettings settings_in,
                                 Clock& clock_in, const SessionMethods& methods)
    : catalogue(catalogue_in),
      settings(std::move(settings_in)),
      clock(clock_in),
      runner(thread_count(settings.threads)),
      memory(settings.limits.max_memory, settings.measure_memory),
      tokens(settings.limits.max_tokens, clock),
      budget({settings.limits.max_particles_in_all, settings.limits.max_springs_in_all}),
      slow_tick_gate(runner.thread_count()),
      frame_threads(std::max<std::size_t>(1, runner.thread_count() / 2)),
      downloads(settings.limits.max_download_bytes,
                settings.cluster.is_used() ? settings.cluster.node : std::string()),
      storage(open_storage(settings, clock)),
      saved_in_memory(storage ? nullptr : std::make_unique<SavedInMemory>()),
      cluster(make_cluster_node(settings, storage.get(), clock, runner.thread_count())),
      relay(make_relay_door(settings, cluster.get(), metrics, frame_threads, clock)),
      environment{catalogue,        settings.limits, settings.instructions, runner,         metrics,
                  budget,           frame_threads,   read_threads,          tokens,         clock,
                  methods,          &downloads,      saved_states(),        saved_scenes(), &memory,
                  &storage_threads, cluster.get(),   settings.device},
      recovery_limits(without_scene_limits(settings.limits)),
      recovery_budget(kUnlimitedResources),
      recovery_environment{catalogue,     recovery_limits, settings.instructions,
                           runner,        metrics,         recovery_budget,
                           frame_threads, read_threads,    tokens,
                           clock,         methods,         &downloads,
                           nullptr,       nullptr,         nullptr,
                           nullptr,       nullptr,         settings.device},
      pool(2 * runner.thread_count()),
      deferred(std::make_shared<DeferredTasks>(pool, clock)),
      creations(boost::asio::make_strand(storage_threads)),
      storage_requests(boost::asio::make_strand(storage_threads)) {
  VAT_CHECK(runner.thread_count() > 0);
  if (storage) tokens.keep_in(storage->tokens(), storage->journal());
  if (cluster && cluster->tokens() != nullptr) {
    tokens.share(*cluster->tokens(), TokenSigner(settings.cluster.key));
  }
}

}  // namespace vat
