// Scores find_growth() on labelled trees and looks for better weights:
//   fit_hierarchy SOURCE_FOLDER            the table of scores of the weights as they are
//   fit_hierarchy SOURCE_FOLDER --search   then a coordinate search over the weights
#include <fmt/core.h>

#include <array>
#include <cmath>
#include <string>

#include "mesher/base/hash.h"
#include "mesher/base/parallel.h"
#include "mesher/io/plant_file.h"
#include "mesher/shells/hierarchy.h"
#include "tests/support/plants/large_plants.h"

namespace liana {
namespace {

/// A tree whose hierarchy is known, as find_growth() sees it.
struct Labelled {
  std::string name;
  bool held_out = false;  ///< scored, never fitted to
  std::vector<ShellShape> shapes;
  std::vector<DomainKind> kinds;
  std::vector<int> parents, unknown;
};

struct Score {
  size_t shells = 0, right = 0;
  double sureness = 0;  ///< Σ confidence of the right ones − that of the wrong ones
};

struct Weight {
  const char* name;
  double HierarchyWeights::*number;
};
constexpr std::array kWeights = {Weight{"gap", &HierarchyWeights::gap},
                                 Weight{"near", &HierarchyWeights::near},
                                 Weight{"off_axis", &HierarchyWeights::off_axis},
                                 Weight{"thicker", &HierarchyWeights::thicker},
                                 Weight{"thicker_from", &HierarchyWeights::thicker_from},
                                 Weight{"thin_end", &HierarchyWeights::thin_end},
                                 Weight{"leaf_gap", &HierarchyWeights::leaf_gap},
                                 Weight{"leaf_near", &HierarchyWeights::leaf_near},
                                 Weight{"leaf_doubt", &HierarchyWeights::leaf_doubt},
                                 Weight{"leaf_thick", &HierarchyWeights::leaf_thick},
                                 Weight{"ground", &HierarchyWeights::ground},
                                 Weight{"ground_height", &HierarchyWeights::ground_height},
                                 Weight{"ground_level", &HierarchyWeights::ground_level},
                                 Weight{"ground_thinner", &HierarchyWeights::ground_thinner},
                                 Weight{"sibling", &HierarchyWeights::sibling},
                                 Weight{"leaf_sibling", &HierarchyWeights::leaf_sibling},
                                 Weight{"sibling_reach", &HierarchyWeights::sibling_reach}};

/// Of length about `by`, any way; the same for the same key on every machine.
Vec3 spread(double by, uint32_t tree, uint32_t domain, uint32_t vertex) {
  Vec3 v;
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const uint32_t key[4] = {tree, domain, vertex, axis};
    v[axis] = 2 * static_cast<double>(hash_bytes(key, sizeof key) >> 11) * 0x1p-53 - 1;
  }
  return by * v;
}

/// How a modeller's file differs from a clean one. In parts of each domain's own size.
struct Damage {
  const char* name;
  double shaken = 0;   ///< spread of the vertices
  double shifted = 0;  ///< of the whole domain, against its parent
};
constexpr std::array kDamages = {Damage{"as modelled", 0, 0}, Damage{"shaken", 0.004, 0},
                                 Damage{"shifted", 0, 0.03}};

Labelled labelled(const SegmentedPlant& plant, const Damage& damage, bool held_out) {
  Labelled tree{plant.name + ", " + damage.name, held_out, {}, {}, {}, {}};
  const auto name = static_cast<uint32_t>(hash_bytes(plant.name.data(), plant.name.size()));
  std::vector<Mesh> surfaces;
  for (const Domain& domain : plant.domains) {
    Mesh surface = domain.surface;
    Eigen::AlignedBox3d box;
    for (const Vec3& p : surface.positions) box.extend(p);
    const double size = box.diagonal().norm();
    const auto index = static_cast<uint32_t>(surfaces.size());
    const Vec3 shift =
        domain.parent.valid() ? spread(damage.shifted * size, name, index, UINT32_MAX) : Vec3(Vec3::Zero());
    for (uint32_t v = 0; v < surface.positions.size(); ++v)
      surface.positions[v] += shift + spread(damage.shaken * size, name, index, v);
    surfaces.push_back(std::move(surface));
    tree.kinds.push_back(domain.kind);
    tree.parents.push_back(domain.parent.valid() ? static_cast<int>(domain.parent.index()) : -1);
  }
  tree.unknown.assign(surfaces.size(), -1);
  tree.shapes.resize(surfaces.size());
  parallel_for(
      surfaces.size(), 0, [&](size_t i, unsigned) { tree.shapes[i] = shape_of(surfaces[i]); }, 16);
  return tree;
}

std::vector<Labelled> all_trees(const std::string& folder) {
  std::vector<Labelled> trees;
  const auto add = [&](SegmentedPlant plant, const char* name, bool held_out) {
    plant.name = name;
    for (const Damage& damage : kDamages) trees.push_back(labelled(plant, damage, held_out));
  };
  add(read_plant(folder + "/data/plants/apple_small.glb"), "apple_small", false);
  add(read_plant(folder + "/data/plants/apple_tree.glb"), "apple_tree", false);
  add(read_plant(folder + "/tests/data/vine_truth.glb"), "vine", false);
  add(flatten(make_branch_hierarchy(120)), "branches", false);
  add(read_plant(folder + "/data/plants/ivy_sprig.glb"), "ivy_sprig", true);
  add(read_plant(folder + "/tests/data/forked_truth.glb"), "forked", true);
  return trees;
}

Score score(const Labelled& tree, const HierarchyWeights& weights) {
  const std::vector<Growth> found =
      find_growth(tree.shapes, tree.kinds, tree.unknown, Vec3::UnitY(), weights);
  Score result{found.size(), 0, 0};
  for (size_t i = 0; i < found.size(); ++i) {
    const bool right = found[i].parent == tree.parents[i];
    result.right += right;
    result.sureness += right ? found[i].confidence : -found[i].confidence;
  }
  return result;
}

/// Share of wrong parents, mean over the trees; one per mille of it as much as 0.05 of mean sureness.
double loss(const std::vector<Labelled>& trees, const HierarchyWeights& weights) {
  double sum = 0;
  size_t fitted = 0;
  for (const Labelled& tree : trees) {
    if (tree.held_out) continue;
    const Score s = score(tree, weights);
    const auto n = static_cast<double>(s.shells);
    sum += 1 - static_cast<double>(s.right) / n + 0.02 * (1 - s.sureness / n);
    ++fitted;
  }
  return sum / static_cast<double>(fitted);
}

void print_scores(const std::vector<Labelled>& trees, const HierarchyWeights& weights) {
  fmt::print("| tree | shells | true parents, % | sureness |\n|---|---|---|---|\n");
  for (const Labelled& tree : trees) {
    const Score s = score(tree, weights);
    const auto n = static_cast<double>(s.shells);
    fmt::print("| {}{} | {} | {:.2f} | {:.3f} |\n", tree.name, tree.held_out ? " (held out)" : "", s.shells,
               100 * static_cast<double>(s.right) / n, s.sureness / n);
  }
  fmt::print("\nloss {:.5f}\n", loss(trees, weights));
}

HierarchyWeights search(const std::vector<Labelled>& trees, HierarchyWeights best) {
  double lowest = loss(trees, best);
  for (const double factor : {1.5, 1.2}) {
    bool better = false;
    for (const Weight& weight : kWeights)
      for (const double by : {factor, 1 / factor}) {
        HierarchyWeights other = best;
        other.*weight.number *= by;
        const double found = loss(trees, other);
        // Less is the noise of a single shell that happens to fall on the other side.
        if (found > lowest - 1e-4) continue;
        lowest = found, best = other, better = true;
        fmt::print("{} = {:.4g}: loss {:.5f}\n", weight.name, best.*weight.number, lowest);
      }
    fmt::print("steps of {}: {}\n", factor, better ? "some were better" : "none is better");
  }
  return best;
}

}  // namespace
}  // namespace liana

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "fit_hierarchy SOURCE_FOLDER [--search]\n");
    return 2;
  }
  const std::vector<liana::Labelled> trees = liana::all_trees(argv[1]);
  liana::HierarchyWeights weights;
  liana::print_scores(trees, weights);
  if (argc > 2 && std::string(argv[2]) == "--search") {
    weights = liana::search(trees, weights);
    liana::print_scores(trees, weights);
  }
  return 0;
}
