// The plan of every catalogue scene against tests/golden/plans: a change that adds work to a scene
// that does not need it is seen in review. VAT_UPDATE_GOLDEN=1 rewrites the files.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include "tests/cli/program.h"

namespace vat::test::plan_test {
namespace {

namespace fs = std::filesystem;

const fs::path kScenes = VAT_SOURCE_DIR "/protocol/scenes";
const fs::path kPlans = VAT_SOURCE_DIR "/tests/golden/plans";

std::set<std::string> stems(const fs::path& folder, const std::string& ending) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ending) names.insert(entry.path().stem().string());
  }
  return names;
}

bool update_golden() {
  const char* value = std::getenv("VAT_UPDATE_GOLDEN");
  return value != nullptr && std::string(value) == "1";
}

TEST(Plan, CatalogueScenesKeepTheirPlans) {
  const std::set<std::string> scenes = stems(kScenes, ".json");
  ASSERT_FALSE(scenes.empty());
  for (const std::string& scene : scenes) {
    const ProgramResult result = run_vat({"simulate", scene, "--plan", "--scenes", kScenes});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const fs::path golden = kPlans / (scene + ".txt");
    if (update_golden()) {
      std::ofstream(golden) << result.out;
    } else {
      ASSERT_TRUE(fs::exists(golden)) << golden << " is missing: run with VAT_UPDATE_GOLDEN=1";
      EXPECT_EQ(result.out, read_file(golden)) << scene;
    }
  }
  EXPECT_EQ(stems(kPlans, ".txt"), scenes) << "a plan without a scene";
}

}  // namespace
}  // namespace vat::test::plan_test
