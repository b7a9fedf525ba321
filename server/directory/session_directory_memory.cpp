// Memory of a server: its use, and the limit of all queues.

#include <chrono>

#include "core/support/check.h"
#include "server/directory/session_directory.h"
#include "server/operations/heap.h"

namespace vat {
namespace {

constexpr std::chrono::seconds kQueueCheck(1);
// Memory of a simulation, measured with the scenes of `vat bench speed`. With saved states and
// diagnostics, a particle needs more.
constexpr std::size_t kParticleBytes = 600;
constexpr std::size_t kSpringBytes = 120;

}  // namespace

ServerMetrics::Memory SessionDirectory::memory_use() {
  const auto now = resources_.clock.now();
  const Resources used = resources_.budget.used();
  ServerMetrics::Memory memory;
  memory.process = resources_.memory.used();
  memory.maximum = resources_.settings.limits.max_memory;
  memory.heap = heap_in_use();
  memory.uses = {
      {"simulations", kParticleBytes * used.particles + kSpringBytes * used.springs},
      {"downloads", resources_.downloads.forget_old(now)},
      {"imports", resources_.imports.forget_old(now)},
      {"database", database_memory()},
  };
  const std::lock_guard lock(tables_.mutex);
  memory.uses.emplace_back("queues", tables_.clients.queue_bytes());
  std::size_t replays = 0;
  for (const auto& [number, session] : tables_.sessions.running()) {
    replays += session->summary().replay_bytes;
  }
  memory.uses.emplace_back("replays", replays);
  return memory;
}

void SessionDirectory::bound_queues() {
  VAT_CHECK(tables_.mutex.is_held());
  const auto now = resources_.clock.now();
  if (now < queue_check_) return;
  queue_check_ = now + kQueueCheck;
  const std::size_t maximum = resources_.settings.limits.max_queue_bytes_in_all;
  const std::size_t closed = tables_.clients.bound_queues(maximum);
  for (std::size_t i = 0; i < closed; ++i) resources_.metrics.add_refusal("queue_bytes_in_all");
}

}  // namespace vat
