#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "protocol/files/output_file.h"

namespace vat {

/// File in the container format Ogawa of Alembic: a tree of groups whose leaves are data. A child
/// is written before its group.
class OgawaFile {
 public:
  /// Place of data or of a group in the file, as groups store it.
  using Place = std::uint64_t;
  static constexpr Place kEmptyData = std::uint64_t{1} << 63;

  static Result<OgawaFile> create(const std::string& name);

  Place add_data(std::string_view bytes);
  Place add_group(std::span<const Place> children);
  /// Returns the first error of the functions above.
  const Status& status() const { return status_; }
  /// Marks the file as complete, with the group at the root of the tree.
  Status complete(Place root);
  /// Renames the complete file to its name.
  Status commit() { return file_.commit(); }

 private:
  explicit OgawaFile(OutputFile file);
  void append(std::string_view bytes);

  OutputFile file_;
  Status status_;
  std::uint64_t end_ = 0;
};

}  // namespace vat
