// What the contacts between shells are worth: the numbers behind find_growth().
#pragma once

namespace liana {

/// A cost is a sum of penalties without unit. Scores of these weights and of the search for better ones are
/// in tests/tools/fit_hierarchy.md: coordinate search over the labelled trees of data/plants and tests/data,
/// each as modelled, shaken and shifted (tests/tools/fit_hierarchy.cpp).
struct HierarchyWeights {
  // Of a branch's end near a bone of another branch.
  double gap = 0.8;             ///< per doubling (ln) of the gap over the end's own radius
  double near = 0.1;            ///< the least scale of that gap, as a share of the parent's radius
  double off_axis = 0.333;      ///< for an end at the parent's bark rather than on its middle line
  double thicker = 1;           ///< per e-fold that the end is thicker than its parent
  double thicker_from = 1.725;  ///< a ratio of radii that is still no thicker
  double thin_end = 0.7;  ///< per e-fold that the end is thinner than the shell's thickest: branches taper

  // Of a leaf's end.
  double leaf_gap = 0.667;   ///< as `gap`, to the bark or the middle line, whichever is nearer
  double leaf_near = 0.06;   ///< the scale of that gap, as a share of the leaf's √area
  double leaf_doubt = 1.05;  ///< times ShellEnd::doubt: a sheet rather begins at the ends of its long axis
  double leaf_thick = 0.15;  ///< per e-fold that the parent is thicker than the plant's thin shoots

  // Of standing on the ground.
  double ground = 0.525;        ///< of any branch
  double ground_height = 6;     ///< per plant height above the lowest end
  double ground_level = 0.03;   ///< of the plant's height: within it, all stands
  double ground_thinner = 0.4;  ///< per e-fold that a branch is thinner than the thickest

  // Beginning where the parent itself begins: a sibling rather than a child.
  double sibling = 1.2;
  double leaf_sibling = 0.1;   ///< less: a leaf may sit in the fork itself
  double sibling_reach = 0.5;  ///< of the parent's radius there

  // Confidence: 1 / Σ exp((own − rival) / temperature), less by exp(−dear (own − dear_from)).
  double temperature = 0.12;  ///< costs that differ by this much are told apart with confidence 0.73
  double dear = 0.6;
  double dear_from = 0.6;
};

}  // namespace liana
