// The stages of bake_plant over all domains of one plant.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "materials/cache/instances.h"
#include "materials/pipeline/bake_plant.h"
#include "mesher/solids/solidify/solid_domain.h"
#include "modal/domains/domain_modes.h"

namespace liana {

class Stages {
 public:
  /// Throws Error{Input} when a group has no law or the law is out of range.
  Stages(const SegmentedPlant& plant, const SpeciesLaw& species, const BakeOptions& options,
         Progress& progress);

  void make_surfaces();      ///< once for each shape; copies are moved
  void carry_descendants();  ///< masses by the law, summed from the tips down
  bool find_modes();         ///< false when a domain failed, so that what its ancestors carry has changed
  Bake apply_laws();
  const std::vector<DomainId>& baked_as() const { return baked_as_; }  ///< after apply_laws
  std::vector<std::string> notes() const;

  /// Summed over the workers of find_modes, s.
  double tet_seconds() const { return tet_seconds_; }
  double mode_seconds() const { return mode_seconds_; }

 private:
  /// A domain on its way through the stages.
  struct Piece {
    SolidDomain solid;          ///< without surface if it came from the cache and was not needed
    Instance instance;          ///< of an earlier piece, or of itself
    uint64_t geometry_key = 0;  ///< in the cache
    bool from_cache = false;    ///< the solid
    DomainMaterial material{};
    TaperLaw taper;
    double subtree_volume = 0;  ///< m³, Σ α_m V: its own and all its descendants', as the law scales them
    std::vector<CarriedMass> carried;  ///< as the domain's default solve carries it: divided by its α_m
    DomainModes modes;                 ///< solved_as: index of a piece
    std::string failure;               ///< why it is left out; empty while it is in
  };

  bool is_copy(size_t index) const { return pieces_[index].instance.source != index; }
  void recall_surfaces();
  void recall_copies();
  void make_surface(size_t index);
  void copy_surface(size_t index);
  void ensure_surface(size_t index);
  void remember_surfaces();
  /// Index of the domain whose modes it takes because it is its copy and neither carries anything; else its
  /// own.
  size_t bare_source(size_t index) const;
  DomainModesOptions mode_options() const;
  /// The modes in the cache; false when they have to be found.
  bool recall_modes(size_t index, const std::unordered_map<uint64_t, size_t>& by_key,
                    const std::vector<uint64_t>& keys);
  void judge_modes(size_t index);

  /// The nearest ancestor still in; invalid when there is none.
  DomainId parent_of(DomainId domain) const;
  /// m³: its own, by the mean of [Wang17] Eq. 11 along it.
  double weighed_volume(const Piece& piece) const;
  double own_mass(const Piece& piece) const;
  void choose_frequencies();  ///< by another model than the power law
  bool is_in(DomainId domain) const { return pieces_[domain.index()].failure.empty(); }
  const std::string& name_of(DomainId domain) const { return plant_.domains[domain.index()].name; }
  std::vector<DomainId> domains_in() const;
  void refuse_failures() const;
  BakedDomain baked(DomainId domain) const;
  std::string describe_failure(DomainId domain) const;
  std::string describe_losses() const;  ///< empty if nothing was lost

  const SegmentedPlant& plant_;
  const SpeciesLaw& species_;
  const BakeOptions& options_;
  Progress& progress_;
  std::vector<Piece> pieces_;
  std::vector<DomainId> baked_as_;
  std::vector<std::string> groups_;  ///< of the species, per domain
  std::vector<std::string> model_notes_;
  double tet_seconds_ = 0, mode_seconds_ = 0;
};

}  // namespace liana
