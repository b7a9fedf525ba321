#include "server/output/frame_writer.h"

#include <algorithm>
#include <filesystem>

#include "core/support/check.h"
#include "server/output/frame_formats.h"

namespace vat {

namespace {

std::string ending_of(const std::string& name) {
  return std::filesystem::path(name).extension().string();
}

}  // namespace

bool is_frame_file_name(const std::string& name) {
  const std::string ending = ending_of(name);
  return ending == ".csv" || ending == ".pvd" || ending == ".ply" || ending == ".npy" ||
         ending == ".npz" || ending == ".glb" || ending == ".abc";
}

bool can_have_surfaces(const std::string& name) {
  const std::string ending = ending_of(name);
  return ending == ".glb" || ending == ".abc";
}

Result<std::unique_ptr<FrameWriter>> create_frame_writer(const std::string& name,
                                                         const FrameContent& content) {
  VAT_CHECK(!content.has_liquid_surfaces || can_have_surfaces(name));
  const std::string ending = ending_of(name);
  if (ending == ".csv") return create_csv_writer(name);
  if (ending == ".npy") return create_npy_writer(name);
  if (ending == ".npz") return create_npz_writer(name, content.frame_count);
  if (ending == ".abc") return create_abc_writer(name, content.has_liquid_surfaces);
  if (ending == ".glb") return create_glb_writer(name, content);
  if (ending == ".pvd") return create_pvd_writer(name, content.frame_count);
  if (ending == ".ply") return create_ply_writer(name, content.frame_count);
  return Error{"bad_file_name", name, std::string("must end in ") + kFrameEndings};
}

std::string series_name(const std::string& name, std::size_t index, std::size_t count) {
  constexpr std::size_t kMinDigits = 4;
  if (count < 2) return name;
  const std::size_t width = std::max(kMinDigits, std::to_string(count - 1).size());
  const std::string digits = std::to_string(index);
  const std::string ending = ending_of(name);
  const std::string stem = name.substr(0, name.size() - ending.size());
  return stem + "-" + std::string(width - std::min(width, digits.size()), '0') + digits + ending;
}

}  // namespace vat
