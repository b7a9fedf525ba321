#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/evaluation/force_model.h"

namespace vat {

/// A static or dynamic connection seen from one of its particles.
struct LocalPair {
  Index other = 0;
  std::uint8_t level = 0;   ///< finer level of both particles
  bool is_contact = false;  ///< repels only
  Real stiffness = 0;
  Real damping = 0;
  Real rest_length = 0;  ///< of a contact: distance at which it begins
  Real layer = 0;        ///< width of the attracting part of a layer [m]
};

/// All connections that can act until a particle has moved by more than half a skin. For each
/// particle there are its springs and then its contacts, both from the finest level to the
/// coarsest. Particles are ordered from the finest level of their connections to the coarsest, so
/// that the connections of a sub-step come first.
class LocalPairs {
 public:
  /// Positions and cells must be those of `at`. Particles that do not move get no entries.
  /// `model_changed`: true in the first call and after commands.
  void build(const ForceModel& force_model, const Configuration& at, const LocalLevels& levels,
             bool model_changed);

  /// Returns whether a particle has moved so far that connections may be missing.
  bool is_stale(const ForceModel& force_model, const Configuration& at);

  /// Calls f(pair) for the connections of particle i of level `due` or finer.
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
  /// The particles with `level` or finer, or with such a connection.
  std::span<const Index> due(int level) const {
    return std::span(order_).first(due_count_[static_cast<std::size_t>(level)]);
  }
  /// The finest level of the connections of rigid particles.
  int finest_rigid() const { return finest_rigid_; }
  /// The finest and the coarsest level of moving particles; 0 without any.
  int finest() const { return finest_; }
  int coarsest() const { return coarsest_; }

 private:
  struct Block {
    std::vector<LocalPair> pairs;
    std::array<std::size_t, kBlockSize + 1> begin;
  };
  /// Fills `blocks` with the pairs that collect(i, pairs) appends for each moving particle.
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
  std::vector<int> finest_of_;          ///< by particle; -1: it does not move
  std::vector<Vec3> built_at_;
  std::vector<Real> farthest_;  ///< by block
  Real skin_ = 0;
  int finest_rigid_ = -1;
  int finest_ = 0;
  int coarsest_ = 0;
};

}  // namespace vat
