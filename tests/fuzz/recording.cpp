#include <vector>

#include "core/saved/sealed_bytes.h"
#include "server/history/recording.h"
#include "tests/fuzz/target.h"

// The input is the content of a recording. The target adds the checksum, since an attacker can do
// that too. An accepted recording is one that a server could have written.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vat;
  VAT_CHECK(!read_recording({data, size}).ok() || size > kSealSize);
  std::vector<std::uint8_t> bytes = begin_sealed({"vat.rec\n", 1, ""});
  if (size > kSealSize) bytes.insert(bytes.end(), data + kSealSize, data + size);
  close_seal(bytes);
  const Result<Recording> recording = read_recording(bytes);
  if (!recording) {
    VAT_CHECK(!recording.errors().front().code.empty());
    return 0;
  }
  VAT_CHECK(!recording.value().log.empty());
  const Result<Recording> again = read_recording(write_recording(recording.value()));
  VAT_CHECK(again.ok() && again.value().log.size() == recording.value().log.size());
  VAT_CHECK(again.value().moments.size() == recording.value().moments.size());
  return 0;
}
