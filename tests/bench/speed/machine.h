#pragma once

#include <cstddef>
#include <string>

namespace vat::bench {

/// The machine of the results. Texts are empty if the system does not provide them.
struct Machine {
  std::string commit;  ///< of the checkout, with "-dirty" if it has changes
  std::string cpu;     ///< name of the model
  std::size_t cores = 0;
};

Machine this_machine();

/// Returns the bytes that the program has allocated, including the allocator's headers; 0 if the
/// allocator does not report them, as with the address sanitizer.
std::size_t heap_in_use();

}  // namespace vat::bench
