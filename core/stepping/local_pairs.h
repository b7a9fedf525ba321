#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/evaluation/force_model.h"

namespace vat {

/// A spring (static connection) or a contact (dynamic connection) of one particle, for local step
/// control.
struct LocalPair {
  Index other = 0;
  std::uint8_t level = 0;   ///< the finer of the levels of both particles
  bool is_contact = false;  ///< a contact; attractive only if `layer` > 0
  Real stiffness = 0;
  Real damping = 0;
  Real rest_length = 0;  ///< rest length of a spring, or threshold of a contact [m]
  Real layer = 0;        ///< width of the attracting part of a layer [m]
};

/// A list of all connections that can act until a particle has moved by more than half the skin
/// (LocalLevels::skin). The springs and the contacts of each particle are ordered from the finest
/// to the coarsest level. The particles are ordered by the finest level of their connections, so
/// that a sub-step visits the first particles only.
class LocalPairs {
 public:
  /// Finds the connections at the configuration `at`, which must be that of the contact list and
  /// the cells. Particles that do not move have no connections in the list. `model_changed` must be
  /// true in the first call and after commands.
  void build(const ForceModel& force_model, const Configuration& at, const LocalLevels& levels,
             bool model_changed);

  /// Returns whether connections may be missing because a particle has moved too far.
  bool is_stale(const ForceModel& force_model, const Configuration& at);

  /// Calls f(pair) for each connection of particle i with the level `due` or finer.
  template <class F>
  void for_each_due(Index i, int due, F&& f) const {
    for (const std::vector<Block>* blocks : {&springs_, &contacts_}) {
      const Block& block = (*blocks)[i / kBlockSize];
      const std::size_t k = i % kBlockSize;
      for (std::size_t p = block.begin[k]; p < block.begin[k + 1]; ++p) {
        if (block.pairs[p].level < due) break;
        f(block.pairs[p]);
      }
    }
  }
  /// Returns the particles with the level `level` or finer, or with a connection of such a level.
  std::span<const Index> due(int level) const {
    return std::span(order_).first(due_count_[static_cast<std::size_t>(level)]);
  }
  /// Returns the finest level of the connections of rigid particles; -1 without moving rigid
  /// particles.
  int finest_rigid() const { return finest_rigid_; }
  /// Return the finest and the coarsest level of moving particles; 0 without moving particles.
  int finest() const { return finest_; }
  int coarsest() const { return coarsest_; }

 private:
  struct Block {
    std::vector<LocalPair> pairs;
    std::array<std::size_t, kBlockSize + 1> begin;
  };
  /// Fills `blocks` with the pairs that collect(i, pairs) appends for each moving particle i.
  template <class Collect>
  static void fill(const ForceModel& force_model, std::vector<Block>& blocks, Collect&& collect);
  void build_springs(const ForceModel& force_model, const Configuration& at,
                     const LocalLevels& levels);
  void build_contacts(const ForceModel& force_model, const Configuration& at,
                      const LocalLevels& levels);
  void sort_particles(const Model& model, const LocalLevels& levels);

  std::vector<Block> springs_;
  std::vector<Block> contacts_;
  std::vector<std::uint8_t> spring_levels_;  ///< levels for which springs_ were built
  std::vector<Index> order_;
  std::vector<std::size_t> due_count_;  ///< by level
  std::vector<int> finest_of_;          ///< by particle; -1: the particle does not move
  std::vector<Vec3> built_at_;
  std::vector<Real> farthest_;  ///< by block
  Real skin_ = 0;
  int finest_rigid_ = -1;
  int finest_ = 0;
  int coarsest_ = 0;
};

}  // namespace vat
