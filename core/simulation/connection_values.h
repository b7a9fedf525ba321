#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/types.h"

namespace vat {

/// Particle of a body, identified by its number; see BodyView.
struct ConnectedParticle {
  BodyId body = 0;
  Index particle = 0;
  bool operator==(const ConnectedParticle&) const = default;
};

/// Spring or contact between two particles.
struct ConnectedPair {
  ConnectedParticle a;
  ConnectedParticle b;
  /// Static spring: strain, length / rest length - 1. Contact: force along the line between the
  /// particles [N]; an attractive force is negative.
  Real value = 0;
};

/// Sample of `total` connections: every `every`-th connection, starting with the first.
struct ConnectionList {
  std::size_t total = 0;
  std::size_t every = 1;
  std::vector<ConnectedPair> sample;
};

/// Selection of the connections to list.
struct ConnectionQuery {
  std::optional<BodyId> body{};  ///< if present, connections of this body only
  std::size_t max_count = 0;     ///< maximum length of each list
};

/// Intact static springs, and contacts that exert a force, within and between bodies.
struct Connections {
  ConnectionList springs;
  ConnectionList contacts;
};

}  // namespace vat
