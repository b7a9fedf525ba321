#include <fstream>

#include "server/settings/serve_settings.h"
#include "server/settings/setting_sources.h"
#include "tests/fuzz/target.h"
#include "tests/support/temporary_folder.h"

// The input is a configuration file. A rejected file changes nothing. The settings of an accepted
// file, printed as a file, give the same settings.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vat;
  static const test::TemporaryFolder kFolder;
  static const std::string kFile = kFolder.file("vat.json");
  const auto apply = [](std::string_view text, ServeSettings& target) {
    std::ofstream(kFile, std::ios::binary) << text;
    SettingSources sources;
    return apply_file(serve_settings(target), kFile, sources);
  };
  const auto printed = [](ServeSettings& target) {
    return describe(serve_settings(target), {}).at("settings");
  };
  ServeSettings target;
  const Json before = printed(target);
  if (const Status applied = apply(fuzz::to_text(data, size), target); !applied) {
    VAT_CHECK(printed(target) == before);
    for (const Error& error : applied.errors())
      VAT_CHECK(!error.code.empty() && !error.message.empty());
    return 0;
  }
  ServeSettings again;
  VAT_CHECK(apply(printed(target).dump(), again));
  VAT_CHECK(printed(again) == printed(target));
  return 0;
}
