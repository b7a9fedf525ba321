#include <vector>

#include "core/saved/sealed_bytes.h"
#include "core/simulation/simulation.h"
#include "tests/fuzz/target.h"

// The input is the content of a saved simulation. The target adds the checksum, since an attacker
// can do that too. An accepted simulation can continue.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vat;
  VAT_CHECK(!Simulation::load({data, size}).ok() || size > kSealSize);
  std::vector<std::uint8_t> bytes = begin_sealed({"vat.sim\n", 1, ""});
  if (size > kSealSize) bytes.insert(bytes.end(), data + kSealSize, data + size);
  close_seal(bytes);
  Result<Simulation> simulation = Simulation::load(bytes);
  if (!simulation) {
    VAT_CHECK(!simulation.errors().front().code.empty());
    return 0;
  }
  VAT_CHECK(simulation.value().snapshot().to_bytes().size() == bytes.size());
  if (simulation.value().particle_count() < 1000) simulation.value().advance(1);
  return 0;
}
