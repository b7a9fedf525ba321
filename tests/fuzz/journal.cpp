#include <filesystem>

#include "tests/fuzz/stores.h"
#include "tests/support/temporary_folder.h"

// The input is the database of sessions and their logs. The store reads it, or reports an error.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vat;
  const test::TemporaryFolder folder;
  fuzz::write_file(folder.file("vat.db"), data, size);
  try {
    fuzz::read_stores(folder.path().string());
  } catch (const StorageError& error) {
    fuzz::check_reason(error);
  }
  return 0;
}
