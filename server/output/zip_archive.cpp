#include "server/output/zip_archive.h"

#include <algorithm>
#include <utility>

#include "core/support/check.h"
#include "server/output/bytes.h"
#include "server/output/crc32.h"

// APPNOTE.TXT 6.3.10, the specification of the format:
// https://pkware.cachefly.net/webdocs/casestudies/APPNOTE.TXT
namespace vat {

namespace {

constexpr std::uint16_t kZip64Version = 45;
constexpr std::uint32_t kInExtra = 0xFFFFFFFF;  // the value is in the ZIP64 field
constexpr std::uint16_t kFirstDate = 0x21;      // 1980-01-01, because equal runs give equal files

template <class... Numbers>
void append_all(std::string& bytes, Numbers... numbers) {
  (append_bytes(bytes, numbers), ...);
}

/// Appends the fields that a local header and a directory entry have in common.
void append_member_fields(std::string& bytes, std::uint32_t crc, std::size_t name_size,
                          std::uint16_t extra_size) {
  constexpr std::uint16_t kStored = 0;
  append_all(bytes, kZip64Version, std::uint16_t{0}, kStored, std::uint16_t{0}, kFirstDate, crc,
             kInExtra, kInExtra, static_cast<std::uint16_t>(name_size), extra_size);
}

}  // namespace

ZipArchive::ZipArchive(OutputFile file, const std::vector<MemberSize>& members)
    : file_(std::move(file)) {
  for (const auto& [name, size] : members) {
    Member member{name, size, end_};
    member.begin = end_ + local_header(member).size();
    end_ = member.begin + size;
    members_.push_back(std::move(member));
  }
}

Status ZipArchive::append(std::size_t member, std::string_view bytes) {
  Member& target = members_[member];
  VAT_CHECK(target.written + bytes.size() <= target.size);
  Status written = file_.write_at(target.begin + target.written, bytes);
  target.written += bytes.size();
  target.crc = crc32(bytes, target.crc);
  return written;
}

Status ZipArchive::fill(std::size_t member) {
  const std::string zeros(64 * 1024, '\0');
  while (members_[member].written < members_[member].size) {
    const std::size_t missing = members_[member].size - members_[member].written;
    const std::string_view part = std::string_view(zeros).substr(0, missing);
    if (Status written = append(member, part); !written) return written;
  }
  return {};
}

Status ZipArchive::complete() {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (Status filled = fill(i); !filled) return filled;
    Status written = file_.write_at(members_[i].header, local_header(members_[i]));
    if (!written) return written;
  }
  return file_.write_at(end_, directory());
}

Status ZipArchive::commit() {
  return file_.commit();
}

std::string ZipArchive::local_header(const Member& member) const {
  std::string bytes = "PK\3\4";
  append_member_fields(bytes, member.crc, member.name.size(), 20);
  bytes += member.name;
  append_all(bytes, std::uint16_t{1}, std::uint16_t{16}, std::uint64_t{member.size},
             std::uint64_t{member.size});
  return bytes;
}

std::string ZipArchive::directory() const {
  std::string bytes;
  for (const Member& member : members_) {
    bytes += "PK\1\2";
    append_bytes(bytes, kZip64Version);
    append_member_fields(bytes, member.crc, member.name.size(), 28);
    append_all(bytes, std::uint16_t{0}, std::uint16_t{0}, std::uint16_t{0}, std::uint32_t{0},
               kInExtra);
    bytes += member.name;
    append_all(bytes, std::uint16_t{1}, std::uint16_t{24}, std::uint64_t{member.size},
               std::uint64_t{member.size}, std::uint64_t{member.header});
  }
  const std::uint64_t size = bytes.size();
  const std::uint64_t count = members_.size();
  bytes += "PK\6\6";  // the end in ZIP64, with the size of the rest of it
  append_all(bytes, std::uint64_t{44}, kZip64Version, kZip64Version, std::uint32_t{0},
             std::uint32_t{0}, count, count, size, std::uint64_t{end_});
  bytes += "PK\6\7";  // its place
  append_all(bytes, std::uint32_t{0}, std::uint64_t{end_ + size}, std::uint32_t{1});
  bytes += "PK\5\6";
  append_all(bytes, std::uint16_t{0}, std::uint16_t{0}, static_cast<std::uint16_t>(count),
             static_cast<std::uint16_t>(count), kInExtra, kInExtra, std::uint16_t{0});
  return bytes;
}

}  // namespace vat
