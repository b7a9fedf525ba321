#pragma once

#include "tests/server/fixture/host.h"
#include "tests/support/temporary_folder.h"

namespace vat::test {

/// A server with one session. The parameter states whether it has a data folder.
class SavedStatesTest : public testing::TestWithParam<bool> {
 protected:
  SavedStatesTest() : catalogue(make_catalogue()) { host.emplace(catalogue, folder(), limits); }
  std::string folder() const { return GetParam() ? temporary.file("data") : ""; }
  void restart(std::optional<ServerLimits> others = {}) {
    host.reset();
    host.emplace(catalogue, folder(), others.value_or(limits));
  }
  TestClient& client() { return *host->client; }

  const TemporaryFolder temporary;
  const Catalogue catalogue;
  ServerLimits limits = unhurried_limits();
  std::optional<Host> host;
};

}  // namespace vat::test
