#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/types.h"

namespace vat {

/// A particle of a body, by its number; see BodyView.
struct ConnectedParticle {
  BodyId body = 0;
  Index particle = 0;
  bool operator==(const ConnectedParticle&) const = default;
};

/// A spring or a contact between two particles.
struct ConnectedPair {
  ConnectedParticle a;
  ConnectedParticle b;
  /// Static spring: strain, length / rest length - 1. Contact: force along the line between the
  /// particles [N], negative for attraction.
  Real value = 0;
};

/// A sample of `total` connections: every `every`-th, starting with the first.
struct ConnectionList {
  std::size_t total = 0;
  std::size_t every = 1;
  std::vector<ConnectedPair> sample;
};

/// The connections to list.
struct ConnectionQuery {
  std::optional<BodyId> body{};  ///< those of this body only
  std::size_t max_count = 0;     ///< of each list
};

/// Intact static springs, and contacts that exert a force, within and between bodies.
struct Connections {
  ConnectionList springs;
  ConnectionList contacts;
};

}  // namespace vat
