// Domains that are copies of an earlier one as modelled: leaves are mostly one mesh, moved, turned and
// scaled.
#pragma once

#include <vector>

#include "mesher/geometry/similarity.h"
#include "mesher/solids/solidify/solid_domain.h"

namespace liana {

/// A domain as a copy of the first of its shape; itself where it is the first.
struct Instance {
  size_t source;
  Similarity similarity;  ///< from the source to the domain
};

/// Copies have the same triangles, every vertex within 0.2 % of the thickness (of a leaf: its own, else
/// 2 volume / area), and a sheet's thickness scaled like the sheet. Mirror images do not match.
std::vector<Instance> find_instances(const SegmentedPlant& plant);

/// Whether a copy is attached where its source is, so that what the source's root maps to is its root.
bool attached_alike(const SegmentedPlant& plant, DomainId source, const SolidDomain& solid, DomainId copy,
                    const Similarity& similarity);

/// The solid of a copy.
SolidDomain moved(const SolidDomain& solid, const Similarity& similarity);

}  // namespace liana
