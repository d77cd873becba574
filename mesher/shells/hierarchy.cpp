#include "mesher/shells/hierarchy.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "mesher/base/error.h"
#include "mesher/shells/contact_costs.h"

namespace liana {
namespace {

constexpr double kTrunkCost = -1;  // of the first trunk, before anything can claim it

struct Placed {
  bool is_placed = false;
  int parent = -1;
  int end = 0;  // the shell's end that is its root
  double cost = 0;
};

/// The tree over all contacts: grown by the cheapest, then mended.
class TreeGrowth {
 public:
  TreeGrowth(const ShellSet& shells, const HierarchyWeights& weights)
      : shells_(shells),
        weights_(weights),
        costs_(shells, weights),
        contacts_(find_contacts(shells, costs_)),
        placed_(shells.shapes.size()),
        first_(placed_.size() + 1, 0),
        carried_(placed_.size()) {
    for (uint32_t c = 0; c < contacts_.size(); ++c) {
      ++first_[contacts_[c].child + 1];
      carried_[contacts_[c].parent].push_back(c);
    }
    for (size_t s = 0; s < placed_.size(); ++s) first_[s + 1] += first_[s];
  }

  std::vector<Growth> grow() {
    grow_from_ground();
    for (int pass = 0; pass < 4 && improve(); ++pass) {
    }
    std::vector<Growth> result(placed_.size());
    for (uint32_t s = 0; s < placed_.size(); ++s)
      result[s] = {placed_[s].parent, confidence(s), shells_.shapes[s].ends[placed_[s].end].point};
    return result;
  }

 private:
  struct Offer {
    double cost;
    uint32_t shell;
    int end, parent;
    bool operator>(const Offer& o) const {
      return std::tie(cost, shell, end, parent) > std::tie(o.cost, o.shell, o.end, o.parent);
    }
  };

  int end_count(uint32_t shell) const { return static_cast<int>(shells_.shapes[shell].ends.size()); }

  /// With the parent placed.
  double full_cost(const Contact& c) const {
    return costs_.with_root(c, shells_.shapes[c.parent].ends[placed_[c.parent].end].along);
  }

  void grow_from_ground() {
    std::priority_queue<Offer, std::vector<Offer>, std::greater<>> offers;
    Offer first{std::numeric_limits<double>::infinity(), 0, 0, -1};
    for (uint32_t s = 0; s < placed_.size(); ++s)
      for (int end = 0; shells_.is_branch(s) && end < end_count(s); ++end) {
        const Offer offer{costs_.ground(s, end), s, end, -1};
        if (offer.cost < first.cost) first = offer;
        offers.push(offer);
      }
    first.cost = kTrunkCost;
    offers.push(first);
    while (!offers.empty()) {
      const Offer offer = offers.top();
      offers.pop();
      Placed& placed = placed_[offer.shell];
      if (placed.is_placed) continue;
      placed = {true, offer.parent, offer.end, offer.cost};
      for (const uint32_t c : carried_[offer.shell])
        if (!placed_[contacts_[c].child].is_placed)
          offers.push(
              {full_cost(contacts_[c]), contacts_[c].child, contacts_[c].end, static_cast<int>(offer.shell)});
    }
    // What no branch came near enough to (only other unreachable shells) goes to the trunk.
    for (Placed& placed : placed_)
      if (!placed.is_placed) placed = {true, static_cast<int>(first.shell), 0, 1e3};
  }

  bool grows_from(uint32_t shell, uint32_t ancestor) const {
    for (int up = static_cast<int>(shell); up >= 0; up = placed_[up].parent)
      if (static_cast<uint32_t>(up) == ancestor) return true;
    return false;
  }

  /// Moves shells to cheaper parents; false when none moved.
  bool improve() {
    bool moved = false;
    for (uint32_t s = 0; s < placed_.size(); ++s) {
      if (placed_[s].cost == kTrunkCost) continue;
      Placed best = placed_[s];
      if (best.parent >= 0) best.cost = current_cost(s);
      for (uint32_t c = first_[s]; c < first_[s + 1]; ++c) {
        const double cost = full_cost(contacts_[c]);
        if (cost < best.cost - 1e-9 && !grows_from(contacts_[c].parent, s))
          best = {true, static_cast<int>(contacts_[c].parent), contacts_[c].end, cost};
      }
      moved = moved || best.parent != placed_[s].parent || best.end != placed_[s].end;
      placed_[s] = best;
    }
    return moved;
  }

  double current_cost(uint32_t shell) const {
    const Placed& placed = placed_[shell];
    double cost = placed.cost;
    bool found = false;
    for (uint32_t c = first_[shell]; c < first_[shell + 1]; ++c)
      if (static_cast<int>(contacts_[c].parent) == placed.parent && contacts_[c].end == placed.end) {
        cost = found ? std::min(cost, full_cost(contacts_[c])) : full_cost(contacts_[c]);
        found = true;
      }
    return cost;
  }

  double confidence(uint32_t shell) const {
    const Placed& placed = placed_[shell];
    if (shells_.known_parents[shell] >= 0) return 1;
    const bool trunk = placed.cost == kTrunkCost;
    const double own = trunk ? costs_.ground(shell, placed.end) : placed.cost;
    double others = 0;
    const auto rival = [&](double cost) {
      others += std::exp(std::clamp((own - cost) / weights_.temperature, -50.0, 50.0));
    };
    for (int end = 0; placed.parent >= 0 && end < end_count(shell); ++end)
      if (shells_.is_branch(shell)) rival(costs_.ground(shell, end));
    std::vector<std::pair<uint32_t, double>> best;  // per parent
    for (uint32_t c = first_[shell]; !trunk && c < first_[shell + 1]; ++c)
      if (static_cast<int>(contacts_[c].parent) != placed.parent && !grows_from(contacts_[c].parent, shell))
        best.push_back({contacts_[c].parent, full_cost(contacts_[c])});
    std::sort(best.begin(), best.end());
    for (size_t i = 0; i < best.size(); ++i)
      if (i == 0 || best[i].first != best[i - 1].first) rival(best[i].second);
    return std::exp(-weights_.dear * std::max(0.0, own - weights_.dear_from)) / (1 + others);
  }

  const ShellSet& shells_;
  const HierarchyWeights& weights_;
  ContactCosts costs_;
  std::vector<Contact> contacts_;  // by child
  std::vector<Placed> placed_;
  std::vector<uint32_t> first_;                 // per shell, its first contact
  std::vector<std::vector<uint32_t>> carried_;  // per shell, the contacts in which it is the parent
};

}  // namespace

std::vector<Growth> find_growth(const std::vector<ShellShape>& shapes, const std::vector<DomainKind>& kinds,
                                const std::vector<int>& known_parents, const Vec3& up,
                                const HierarchyWeights& weights) {
  require(shapes.size() == kinds.size() && shapes.size() == known_parents.size(),
          "find_growth: one of each per shell");
  const ShellSet shells{shapes, kinds, known_parents, up};
  return TreeGrowth(shells, weights).grow();
}

}  // namespace liana
