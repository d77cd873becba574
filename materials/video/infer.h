// Materials from a video: [Wang17] §7 on one screen.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "materials/bake/bake.h"
#include "materials/law/species_file.h"
#include "materials/video/fit_law.h"
#include "materials/video/modes/point_modes.h"
#include "materials/video/modes/tree_modes.h"

namespace liana {

/// What the user says a point sits on: "still" (part of what does not move), a domain of the plant by name or
/// "#id", or GROUP:LENGTH such as "level1:0.82" (m).
struct PointAssignment {
  std::string point, target;
};

/// Reads "NAME=TARGET". Throws Error{Usage}.
PointAssignment parse_assignment(const std::string& text);
/// CSV with the columns point, target. Throws Error{Input} "file:line: ...".
std::vector<PointAssignment> parse_assignments(std::string_view text, const std::string& file);

struct InferOptions {
  std::vector<PointAssignment> assignments;
  MotionOptions motion;
  WindOptions wind;
  double trunk_length = 0;  ///< m, for a trunk that is not tracked itself; 0: the plant's, if there is one
};

struct InferResult {
  std::string source;
  double frames_per_second = 0;
  size_t frames = 0;
  std::vector<PointModes> unassigned;  ///< tracked points that are no branch's
  TreeModes tree;
  std::vector<FittedGroup> groups;  ///< empty when no point is assigned
  std::vector<std::string> notes;
  size_t left_out = 0;  ///< assigned points that could not be used; each has a note
};

/// `plant` gives lengths and groups of named domains (may be null). Throws Error when nothing assigned can be
/// used.
InferResult infer(const PointTracks& tracks, const SpeciesLaw& base, const Bake* plant,
                  const InferOptions& options);

/// The base species with the fitted groups in place of its own, every number with its source.
SpeciesFile inferred_species(const SpeciesFile& base, const InferResult& result, const std::string& name);

}  // namespace liana
