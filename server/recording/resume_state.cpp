#include "server/recording/resume_state.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "core/saved/archive.h"
#include "core/saved/sealed_bytes.h"
#include "protocol/files/output_file.h"
#include "protocol/frame/frame_layout.h"
#include "server/storage/sqlite/compression.h"
#include "server/storage/sqlite/storage_error.h"

namespace vat {
namespace {

constexpr Seal kStateSeal{"vat.rst\n", 1, "the state of a recording"};
constexpr std::size_t kMaxSnapshotBytes = std::size_t{1} << 31;

template <class Archive>
void pass_order(Archive& archive, Of<Archive, RecordingOrder>& order) {
  archive(order.program, order.instruction_set, order.scene, order.frame_seconds, order.step,
          order.max_error, order.key_every);
}

Error other_option(const std::string& what) {
  return {"other_options", "", "the recording was made with another " + what};
}

Error state_error(const std::string& name, const std::string& code, const std::string& message) {
  return {code, name, message};
}

}  // namespace

Status check_same(const RecordingOrder& recorded, const RecordingOrder& given) {
  if (recorded.program != given.program) {
    return other_option("version of the program (" + recorded.program + ")");
  }
  if (recorded.scene != given.scene) return other_option("scene");
  if (recorded.instruction_set != given.instruction_set) {
    return other_option("--isa (" + recorded.instruction_set + ")");
  }
  if (recorded.frame_seconds != given.frame_seconds || recorded.step != given.step) {
    return other_option("--every");
  }
  if (recorded.max_error != given.max_error) return other_option("--max-error");
  if (recorded.key_every != given.key_every) return other_option("--key-every");
  return {};
}

std::vector<std::uint8_t> header_of_frame(std::span<const std::uint8_t> frame) {
  const auto header = frame.first(std::min(frame.size(), frame_layout::kHeaderSize));
  return {header.begin(), header.end()};
}

std::string resume_name(const std::string& recording) {
  return recording + ".state";
}

Status write_resume_state(const std::string& recording, const ResumeState& state) {
  std::vector<std::uint8_t> bytes = begin_sealed(kStateSeal);
  SavingArchive archive(bytes);
  pass_order(archive, state.order);
  archive(state.step, state.frames, state.last_header, compress(state.snapshot));
  close_seal(bytes);
  Result<OutputFile> file = OutputFile::create(resume_name(recording));
  if (!file) return file.errors();
  const Status written =
      file.value().append({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  return written ? file.value().commit() : written;
}

Result<ResumeState> read_resume_state(const std::string& recording) {
  const std::string name = resume_name(recording);
  std::ifstream file(name, std::ios::binary);
  if (!file) {
    return state_error(name, "io_error",
                       "cannot be read; only an interrupted recording can be resumed");
  }
  const std::vector<char> raw{std::istreambuf_iterator<char>(file), {}};
  const std::vector<std::uint8_t> bytes(raw.begin(), raw.end());
  const auto content = open_sealed(kStateSeal, bytes);
  if (!content) {
    const Error& error = content.errors().front();
    return state_error(name, error.code, error.message);
  }
  LoadingArchive archive(content.value());
  ResumeState state;
  std::vector<std::uint8_t> compressed;
  pass_order(archive, state.order);
  archive(state.step, state.frames, state.last_header, compressed);
  if (archive.failed() || archive.left() > 0) {
    return state_error(name, "bad_value", "its values are not those of a state");
  }
  try {
    state.snapshot = decompress(compressed, kMaxSnapshotBytes);
  } catch (const StorageError& error) {
    return state_error(name, "damaged", error.what());
  }
  return state;
}

void remove_resume_state(const std::string& recording) {
  std::error_code ignored;  // there may be no state
  std::filesystem::remove(resume_name(recording), ignored);
}

}  // namespace vat
