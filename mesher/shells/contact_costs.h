// Which ends of a plant's shells lie near which branches, and what it costs to grow from there.
#pragma once

#include <vector>

#include "mesher/plant/segmented_plant.h"
#include "mesher/shells/hierarchy_weights.h"
#include "mesher/shells/shell_shape.h"

namespace liana {

/// An end of a shell near a branch.
struct Contact {
  uint32_t child, parent;
  uint8_t end;
  double cost;    ///< but for what depends on where the parent begins
  double along;   ///< on the parent, from its first end
  double radius;  ///< of the parent there
};

/// The shells to be joined; all arrays have one entry for each.
struct ShellSet {
  const std::vector<ShellShape>& shapes;
  const std::vector<DomainKind>& kinds;
  const std::vector<int>& known_parents;  ///< -1 where they are to be found
  Vec3 up;                                ///< unit

  bool is_branch(size_t shell) const {
    return kinds[shell] == DomainKind::Branch && !shapes[shell].bones.empty();
  }
};

/// Costs that depend on two shells, or on one and the plant's measures.
class ContactCosts {
 public:
  ContactCosts(const ShellSet& shells, const HierarchyWeights& weights);

  /// Of a trunk that begins with this end; infinite for a leaf, and where the parent is known.
  double ground(uint32_t shell, int end) const;
  /// What can be said of an end near a bone before it is known where the bone's branch begins.
  Contact contact(uint32_t shell, int end, uint32_t parent, const Bone& bone) const;
  /// The end nearest to the parent that is known, at the lowest cost of all.
  Contact known_contact(uint32_t shell) const;
  /// What a contact costs when its parent begins at `root`, a distance from its first end: what begins where
  /// it begins is rather its sibling.
  double with_root(const Contact& contact, double root) const;

 private:
  double thin_end(uint32_t shell, int end) const;

  const ShellSet& shells_;
  const HierarchyWeights& weights_;
  std::vector<double> thickest_end_;  // per shell
  double lowest_ = 0, height_ = 1, thickest_ = 0;
  double thin_ = 1;  // radius that a tenth of the branches is below
};

/// By child; of each end the cheapest 24. Where nothing is near, the search goes on at twice the distance.
std::vector<Contact> find_contacts(const ShellSet& shells, const ContactCosts& costs);

}  // namespace liana
