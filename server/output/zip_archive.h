#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/files/output_file.h"

namespace vat {

/// ZIP archive of uncompressed members whose sizes are known at the start, so that all members can
/// grow at the same time. Uses the ZIP64 extension, without a limit of 4 GiB.
class ZipArchive {
 public:
  struct MemberSize {
    std::string name;
    std::size_t size = 0;
  };

  ZipArchive(OutputFile file, const std::vector<MemberSize>& members);

  /// Appends bytes to a member.
  Status append(std::size_t member, std::string_view bytes);
  /// Fills the members with zeros up to their sizes, and writes the directory.
  Status complete();
  /// Renames the complete file to its name.
  Status commit();

 private:
  struct Member {
    std::string name;
    std::size_t size = 0;
    std::size_t header = 0;  ///< offset in the file
    std::size_t begin = 0;   ///< offset of the content
    std::size_t written = 0;
    std::uint32_t crc = 0;
  };

  Status fill(std::size_t member);
  std::string local_header(const Member& member) const;
  std::string directory() const;

  OutputFile file_;
  std::vector<Member> members_;
  std::size_t end_ = 0;  ///< offset of the directory
};

}  // namespace vat
