#pragma once

#include <string>

#include "protocol/json/json_reader.h"
#include "server/nats/nats_error.h"
#include "server/storage/sqlite/storage_error.h"

namespace vat {

/// Returns the result of `work`. Throws StorageError in place of NatsError and of errors of JSON.
template <class Work>
auto with_storage_errors(const Work& work) {
  try {
    return work();
  } catch (const NatsError& error) {
    const bool is_refused = error.kind() == NatsError::Kind::refused;
    throw StorageError(is_refused ? StorageError::Kind::failed : StorageError::Kind::unreachable,
                       std::string("the saved data of the cluster: ") + error.what());
  } catch (const Json::exception& error) {
    throw StorageError(StorageError::Kind::corrupt,
                       std::string("the saved data of the cluster: ") + error.what());
  }
}

}  // namespace vat
