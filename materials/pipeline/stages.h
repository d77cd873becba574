// The stages of bake_plant over all domains of one plant.
#pragma once

#include <string>
#include <vector>

#include "materials/pipeline/bake_plant.h"
#include "mesher/surface/solid_domain.h"
#include "modal/domain_modes.h"

namespace liana {

class Stages {
 public:
  /// Throws Error{Input} when a group has no law or the law is out of range.
  Stages(const SegmentedPlant& plant, const SpeciesLaw& species, const BakeOptions& options,
         Progress& progress);

  void make_surfaces();
  void carry_descendants();  ///< masses by the law, summed from the tips down
  bool find_modes();         ///< false when a domain failed, so that what its ancestors carry has changed
  Bake apply_laws();
  std::vector<std::string> notes() const;

  /// Summed over the workers of find_modes, s.
  double tet_seconds() const { return tet_seconds_; }
  double mode_seconds() const { return mode_seconds_; }

 private:
  /// A domain on its way through the stages.
  struct Piece {
    SolidDomain solid;
    DomainMaterial material{};
    double subtree_mass = 0;           ///< kg: its own and all its descendants', as the law scales them
    std::vector<CarriedMass> carried;  ///< as the domain's default solve carries it: divided by its α_m
    DomainModes modes;                 ///< solved_as: index of a piece
    std::string failure;               ///< why it is left out; empty while it is in
  };

  /// The nearest ancestor still in; invalid when there is none.
  DomainId parent_of(DomainId domain) const;
  double own_mass(const Piece& piece) const;
  void choose_frequencies();  ///< by another model than the power law
  bool is_in(DomainId domain) const { return pieces_[domain.index()].failure.empty(); }
  const std::string& name_of(DomainId domain) const { return plant_.domains[domain.index()].name; }
  std::vector<DomainId> domains_in() const;
  void refuse_failures() const;
  BakedDomain baked(DomainId domain) const;
  std::string describe_failure(DomainId domain) const;

  const SegmentedPlant& plant_;
  const SpeciesLaw& species_;
  const BakeOptions& options_;
  Progress& progress_;
  std::vector<Piece> pieces_;
  std::vector<std::string> groups_;  ///< of the species, per domain
  std::vector<std::string> model_notes_;
  double tet_seconds_ = 0, mode_seconds_ = 0;
};

}  // namespace liana
