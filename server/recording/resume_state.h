#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/support/result.h"

namespace vat {

/// Options of a recording that determine its frames. A resumed run needs the same options.
struct RecordingOrder {
  std::string program;              ///< version
  std::string instruction_set;      ///< see to_string(InstructionSet)
  std::string scene;                ///< JSON text
  double frame_seconds = 0;         ///< [s]
  double step = 0;                  ///< [s]
  std::optional<double> max_error;  ///< [m]
  std::optional<std::uint64_t> key_every;

  bool operator==(const RecordingOrder&) const = default;
};

/// Returns an error that names the first option that differs.
Status check_same(const RecordingOrder& recorded, const RecordingOrder& given);

/// State of an interrupted run, from which the recording continues. It is stored beside the
/// recording, in the file resume_name().
struct ResumeState {
  RecordingOrder order;
  std::uint64_t step = 0;                 ///< number of steps until the state
  std::uint64_t frames = 0;               ///< number of frames until the state
  std::vector<std::uint8_t> last_header;  ///< first bytes of the last frame, see header_of_frame()
  std::vector<std::uint8_t> snapshot;     ///< see Snapshot::to_bytes()
};

/// Returns the first bytes of a frame, which identify the frame in its recording.
std::vector<std::uint8_t> header_of_frame(std::span<const std::uint8_t> frame);

/// Returns the name of the file with the state of an interrupted recording.
std::string resume_name(const std::string& recording);

/// Writes the state of a recording to its file.
Status write_resume_state(const std::string& recording, const ResumeState& state);
/// Reads the state of a recording. Error codes: io_error, other_format, other_version,
/// wrong_length, damaged, bad_value.
Result<ResumeState> read_resume_state(const std::string& recording);
/// Deletes the state of a recording, if there is one.
void remove_resume_state(const std::string& recording);

}  // namespace vat
