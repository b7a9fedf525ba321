#pragma once

#include <cstddef>
#include <string>
#include <utility>

#include "protocol/files/output_file.h"
#include "server/output/frame_writer.h"

namespace vat {

/// Writer of one file per output time. A file with its final name is complete.
class SeriesWriter : public FrameWriter {
 public:
  SeriesWriter(std::string name, std::size_t frame_count)
      : name_(std::move(name)), frame_count_(frame_count) {}

  Status write(const Simulation& simulation) final {
    Result<OutputFile> file = OutputFile::create(series_name(name_, next_frame_++, frame_count_));
    if (!file) return file.errors();
    if (Status written = write_content(simulation, file.value()); !written) return written;
    return file.value().commit();
  }
  Status finish() final { return {}; }

 protected:
  /// Writes the whole content of the file for the current state.
  virtual Status write_content(const Simulation& simulation, OutputFile& file) = 0;

 private:
  std::string name_;
  std::size_t frame_count_;
  std::size_t next_frame_ = 0;
};

}  // namespace vat
