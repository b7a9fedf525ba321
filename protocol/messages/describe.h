#pragma once

#include <string>

#include "core/simulation/simulation.h"
#include "protocol/json/json_reader.h"

/// JSON descriptions of a simulation (PROTOCOL.md).
namespace vat {

/// Returns the `bodies` of a session's description. The bodies do not change within an epoch.
Json describe_bodies(const Simulation& simulation);
/// Returns the `materials` of a session's description: names, complete appearances, and
/// the strains at which springs tear.
Json describe_materials(const Scene& scene);
/// Returns the vat at offset zero, or `null` without a vat.
Json describe_vat(const std::optional<Vat>& vat);
/// Returns a body in the result of state.query, with full precision.
Json describe_state(const BodyView& body);
/// Returns a flat list of body and particle numbers of all pairs. Also returns a list of values,
/// which are rounded to four digits. `values` is the name of the second list.
Json describe_connections(const ConnectionList& list, const char* values);
/// Returns the sums of the diagnostics over all bodies.
Json describe_diagnostics(const Diagnostics& diagnostics);
Json describe_guard(const GuardEvent& event, std::uint64_t tick);
/// Returns a hash as 16 hexadecimal digits.
std::string describe_hash(std::uint64_t hash);

}  // namespace vat
