#pragma once

#include <span>
#include <string>

#include "core/simulation/simulation.h"
#include "protocol/json/json_reader.h"

/// JSON of what clients are told about a simulation; see PROTOCOL.md.
namespace vat {

Json to_json(const Vec3& vector);
Json to_json(const Quat& orientation);

/// The `bodies` of a description: what does not change within an epoch.
Json describe_bodies(const Simulation& simulation);
/// `null`, or the vat at offset zero.
Json describe_vat(const std::optional<Vat>& vat);
/// One body of a `state.query`, with all its bits.
Json describe_state(const BodyView& body);
/// Numbers of particles and their bodies, pair by pair, as one flat list; and `values`, of a word
/// that tells what they are, rounded to four digits.
Json describe_connections(const ConnectionList& list, const char* values);
/// Sums over all bodies.
Json describe_diagnostics(const Diagnostics& diagnostics);
Json describe_guard(const GuardEvent& event, std::uint64_t tick);
/// 16 hexadecimal digits.
std::string describe_hash(std::uint64_t hash);

}  // namespace vat
