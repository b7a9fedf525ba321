#pragma once

#include <functional>
#include <string>
#include <utility>

#include "core/simulation/simulation.h"

/// User commands as values. Bodies are given by name. An unknown name becomes an unused id.
namespace vat::test {

using Command = std::function<Status(Simulation&)>;

inline BodyId id_of(const Simulation& simulation, const std::string& name) {
  return simulation.find_body(name).value_or(9999);
}

inline Command set_gravity(const Vec3& gravity) {
  return [=](Simulation& s) { return s.set_gravity(gravity); };
}
inline Command set_interface(const InterfaceDescription& interface) {
  return [=](Simulation& s) { return s.set_interface(interface); };
}
inline Command add_body(const BodyDescription& body) {
  return [=](Simulation& s) {
    const Result<BodyId> id = s.add_body(body);
    return id ? Status() : Status(id.errors());
  };
}
inline Command remove_body(const std::string& body) {
  return [=](Simulation& s) { return s.remove_body(id_of(s, body)); };
}
inline Command apply_force(const std::string& body, const Vec3& force, Real duration) {
  return [=](Simulation& s) { return s.apply_force(id_of(s, body), force, duration); };
}
inline Command grab(std::uint64_t hand, const std::string& body, Index particle,
                    const Vec3& target) {
  return [=](Simulation& s) { return s.grab_start(hand, id_of(s, body), particle, target); };
}
inline Command move_grab(std::uint64_t hand, const Vec3& target) {
  return [=](Simulation& s) { return s.grab_move(hand, target); };
}
inline Command end_grab(std::uint64_t hand) {
  return [=](Simulation& s) { return s.grab_end(hand); };
}
/// Combines two commands. The first must succeed.
inline Command operator+(const Command& first, const Command& second) {
  return [=](Simulation& s) {
    const Status status = first(s);
    return status ? second(s) : status;
  };
}

}  // namespace vat::test
