#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/evaluation/force_model.h"

namespace vat {

/// A static or dynamic connection seen from one of its particles.
struct LocalPair {
  Index other = 0;
  std::uint8_t level = 0;   ///< the finer of its two particles'
  bool is_contact = false;  ///< pushes only
  Real stiffness = 0;
  Real damping = 0;
  Real rest_length = 0;  ///< of a contact, the distance at which it begins
  Real layer = 0;        ///< of a layer: the width of its part that pulls [m]
};

/// Every connection that can act as long as no particle moves by more than half a skin, by
/// particle: its springs, then its contacts, either from the finest level to the coarsest; and the
/// particles from the finest of their connections to the coarsest. So what is due in a sub-step
/// comes first.
class LocalPairs {
 public:
  /// Positions and cells must be those of `at`. Particles that nothing moves get no entries.
  /// The first time, or after commands, `model_changed`.
  void build(const ForceModel& force_model, const Configuration& at, const LocalLevels& levels,
             bool model_changed);

  /// Whether a particle has moved so far that connections may be missing.
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
  /// The particles with a connection of `level` or finer, or of such a level themselves.
  std::span<const Index> due(int level) const {
    return std::span(order_).first(due_count_[static_cast<std::size_t>(level)]);
  }
  /// The finest level of any rigid particle's connections.
  int finest_rigid() const { return finest_rigid_; }
  /// The finest and the coarsest level of what moves; 0 where nothing does.
  int finest() const { return finest_; }
  int coarsest() const { return coarsest_; }

 private:
  struct Block {
    std::vector<LocalPair> pairs;
    std::array<std::size_t, kBlockSize + 1> begin;
  };
  /// Fills `blocks` with what collect(i, pairs) appends for each particle that moves.
  template <class Collect>
  static void fill(const ForceModel& force_model, std::vector<Block>& blocks, Collect&& collect);
  void build_springs(const ForceModel& force_model, const Configuration& at,
                     const LocalLevels& levels);
  void build_contacts(const ForceModel& force_model, const Configuration& at,
                      const LocalLevels& levels);
  void sort_particles(const Model& model, const LocalLevels& levels);

  std::vector<Block> springs_;
  std::vector<Block> contacts_;
  std::vector<std::uint8_t> spring_levels_;  ///< with which springs_ were built
  std::vector<Index> order_;
  std::vector<std::size_t> due_count_;  ///< by level
  std::vector<int> finest_of_;          ///< by particle; -1: nothing moves it
  std::vector<Vec3> built_at_;
  std::vector<Real> farthest_;  ///< by block
  Real skin_ = 0;
  int finest_rigid_ = -1;
  int finest_ = 0;
  int coarsest_ = 0;
};

}  // namespace vat
