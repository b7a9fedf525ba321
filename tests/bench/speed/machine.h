#pragma once

#include <cstddef>
#include <string>

namespace vat::bench {

/// Where figures come from. Texts are empty where the system does not tell.
struct Machine {
  std::string commit;  ///< of the checkout, with "-dirty" where it was changed since
  std::string cpu;     ///< the model's name
  std::size_t cores = 0;
};

Machine this_machine();

/// Bytes that the program has allocated and not freed, the allocator's own headers included; 0
/// where the allocator does not tell (as of the address sanitizer).
std::size_t heap_in_use();

}  // namespace vat::bench
