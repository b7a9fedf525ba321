#include "server/output/series_writer.h"

#include <utility>

#include "server/output/output_file.h"

namespace vat {

SeriesWriter::SeriesWriter(std::string name, std::size_t frame_count)
    : name_(std::move(name)), frame_count_(frame_count) {}

Status SeriesWriter::write(const Simulation& simulation) {
  Result<OutputFile> file = OutputFile::create(series_name(name_, next_frame_++, frame_count_));
  if (!file) return file.errors();
  if (Status written = file.value().append(content(simulation)); !written) return written;
  return file.value().commit();
}

}  // namespace vat
