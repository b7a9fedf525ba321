#include "server/storage/backup.h"

#include "tests/fuzz/stores.h"
#include "tests/support/temporary_folder.h"

// The input is a backup file. A restored folder can be read; a refused file leaves no sessions.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vat;
  const test::TemporaryFolder folder;
  fuzz::write_file(folder.file("backup"), data, size);
  try {
    restore_backup(folder.file("backup"), folder.file("data"));
  } catch (const StorageError& error) {
    fuzz::check_reason(error);
    VAT_CHECK(!std::filesystem::exists(folder.file("data/vat.db")));
    return 0;
  }
  try {
    fuzz::read_stores(folder.file("data"));
  } catch (const StorageError& error) {
    fuzz::check_reason(error);  // a value that the schema allows and the store does not
  }
  return 0;
}
