#include <vector>

#include "core/saved/sealed_bytes.h"
#include "core/simulation/simulation.h"
#include "tests/fuzz/target.h"

// The input is a saved simulation. The target corrects the checksum, since an attacker can do that
// too. An accepted simulation can be saved again, and can continue.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vat;
  VAT_CHECK(!Simulation::load({data, size}).ok() || size > kSealSize);
  const std::uint32_t version = size > kSealSize ? sealed_version({data, size}) : 0;
  std::vector<std::uint8_t> bytes = begin_sealed({"vat.sim\n", version, ""});
  if (size > kSealSize) bytes.insert(bytes.end(), data + kSealSize, data + size);
  close_seal(bytes);
  Result<Simulation> simulation = Simulation::load(bytes);
  if (!simulation) {
    VAT_CHECK(!simulation.errors().front().code.empty());
    return 0;
  }
  const std::vector<std::uint8_t> again = simulation.value().snapshot().to_bytes();
  VAT_CHECK(version < 3 || again.size() == bytes.size());
  VAT_CHECK(Simulation::load(again).ok());
  if (simulation.value().particle_count() < 1000) simulation.value().advance(1);
  return 0;
}
