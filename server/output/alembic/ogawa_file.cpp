#include "server/output/alembic/ogawa_file.h"

#include <string>
#include <utility>

#include "server/output/bytes.h"

// The format is described by the sources of its library: https://github.com/alembic/alembic
namespace vat {

namespace {

/// Returns the first bytes of the file: magic, whether it is complete, version, and the root.
std::string ogawa_header(bool is_complete, OgawaFile::Place root) {
  std::string header = "Ogawa";
  header += is_complete ? '\xff' : '\0';
  header += std::string("\0\1", 2);
  append_bytes(header, root);
  return header;
}

}  // namespace

OgawaFile::OgawaFile(OutputFile file) : file_(std::move(file)) {
  append(ogawa_header(false, 0));
}

Result<OgawaFile> OgawaFile::create(const std::string& name) {
  Result<OutputFile> file = OutputFile::create(name);
  if (!file) return file.errors();
  return OgawaFile(std::move(file).value());
}

void OgawaFile::append(std::string_view bytes) {
  if (status_) status_ = file_.append(bytes);
  end_ += bytes.size();
}

OgawaFile::Place OgawaFile::add_data(std::string_view bytes) {
  if (bytes.empty()) return kEmptyData;
  const Place place = end_ | kEmptyData;
  std::string size;
  append_bytes(size, std::uint64_t{bytes.size()});
  append(size);
  append(bytes);
  return place;
}

OgawaFile::Place OgawaFile::add_group(std::span<const Place> children) {
  if (children.empty()) return 0;
  const Place place = end_;
  std::string bytes;
  append_bytes(bytes, std::uint64_t{children.size()});
  for (const Place child : children) append_bytes(bytes, child);
  append(bytes);
  return place;
}

Status OgawaFile::complete(Place root) {
  if (!status_) return status_;
  return file_.write_at(0, ogawa_header(true, root));
}

}  // namespace vat
