#include "mesher/shells/hierarchy.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "mesher/base/error.h"
#include "mesher/base/parallel.h"
#include "mesher/geometry/box_tree.h"

namespace liana {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTemperature = 0.12;  // costs that differ by this much are told apart with confidence 0.73
constexpr size_t kMostContacts = 24;   // of one end

/// An end of a shell near a branch.
struct Contact {
  uint32_t child, parent;
  uint8_t end;
  double cost;    // but for what depends on where the parent begins
  double along;   // on the parent, from its first end
  double radius;  // of the parent there
};

struct Placed {
  bool is_placed = false;
  int parent = -1;
  int end = 0;  // the shell's end that is its root
  double cost = 0;
};

class Grower {
 public:
  Grower(const std::vector<ShellShape>& shapes, const std::vector<DomainKind>& kinds,
         const std::vector<int>& known, const Vec3& up)
      : shapes_(shapes),
        kinds_(kinds),
        known_(known),
        up_(up),
        placed_(shapes.size()),
        thickest_end_(shapes.size(), 0) {
    for (size_t s = 0; s < shapes.size(); ++s)
      for (const ShellEnd& end : shapes[s].ends) thickest_end_[s] = std::max(thickest_end_[s], end.radius);
    measure_plant();
    find_contacts();
  }

  std::vector<Growth> grow() {
    grow_from_ground();
    for (int pass = 0; pass < 4 && improve(); ++pass) {
    }
    std::vector<Growth> result(shapes_.size());
    for (uint32_t s = 0; s < shapes_.size(); ++s)
      result[s] = {placed_[s].parent, confidence(s), shapes_[s].ends[placed_[s].end].point};
    return result;
  }

 private:
  bool is_branch(size_t shell) const {
    return kinds_[shell] == DomainKind::Branch && !shapes_[shell].bones.empty();
  }

  void measure_plant() {
    lowest_ = kInfinity;
    double highest = -kInfinity;
    std::vector<double> radii;
    for (size_t s = 0; s < shapes_.size(); ++s) {
      for (const ShellEnd& end : shapes_[s].ends) {
        highest = std::max(highest, end.point.dot(up_));
        if (is_branch(s)) lowest_ = std::min(lowest_, end.point.dot(up_));
      }
      if (is_branch(s)) thickest_ = std::max(thickest_, thickest_end_[s]), radii.push_back(thickest_end_[s]);
    }
    if (radii.empty()) return;
    const auto tenth = radii.begin() + static_cast<ptrdiff_t>(radii.size() / 10);
    std::nth_element(radii.begin(), tenth, radii.end());
    thin_ = std::max(*tenth, 1e-9 * thickest_);
    height_ = std::max(highest - lowest_, 1e-300);
  }

  /// Of a shell that begins with this end: branches taper.
  double thin_end_cost(uint32_t shell, int end) const {
    if (!is_branch(shell)) return 0;
    return 0.7 * std::log(std::max(1.0, thickest_end_[shell] /
                                            std::max(shapes_[shell].ends[end].radius, 1e-9 * thickest_)));
  }

  double ground_cost(uint32_t shell, int end) const {
    if (!is_branch(shell) || known_[shell] >= 0) return kInfinity;
    const ShellEnd& e = shapes_[shell].ends[end];
    const double height = (e.point.dot(up_) - lowest_) / height_;
    return 0.35 + 6 * std::max(0.0, height - 0.03) + thin_end_cost(shell, end) +
           0.4 * std::log(thickest_ / std::max(thickest_end_[shell], 1e-9 * thickest_));
  }

  /// What can be said of an end near a bone before it is known where the bone's branch begins.
  Contact contact(uint32_t shell, int end, uint32_t parent, const Bone& b) const {
    const ShellEnd& e = shapes_[shell].ends[end];
    const Vec3 axis = b.to - b.from;
    const double t =
        std::clamp((e.point - b.from).dot(axis) / std::max(axis.squaredNorm(), 1e-300), 0.0, 1.0);
    Contact c{shell, parent, static_cast<uint8_t>(end), 0, 0, 0};
    c.along = b.from_along + t * (b.to_along - b.from_along);
    c.radius = std::max(b.from_radius + t * (b.to_radius - b.from_radius), 1e-9 * thickest_);
    const double off_axis = (e.point - b.from - t * axis).norm();
    if (is_branch(shell)) {
      const double gap = std::max(0.0, off_axis - c.radius),
                   near = std::max({e.radius, 0.1 * c.radius, 1e-300});
      c.cost = 1.2 * std::log1p(gap / near) + 0.5 * std::min(off_axis / c.radius, 1.0) +
               thin_end_cost(shell, end) + 1.5 * std::log(std::max(1.0, e.radius / (1.15 * c.radius)));
    } else {
      // A leaf begins on the bark or on the middle line, and rather on thin shoots.
      const double gap = std::min(std::abs(off_axis - c.radius), off_axis);
      const double near = std::max(0.04 * std::sqrt(shapes_[shell].area), 1e-300);
      c.cost =
          1.2 * std::log1p(gap / near) + 0.7 * e.doubt + 0.15 * std::log(std::max(1.0, c.radius / thin_));
    }
    return c;
  }

  /// The end nearest to a parent that is known, at no cost.
  Contact known_contact(uint32_t shell) const {
    Contact best{};
    best.cost = kInfinity;
    const std::vector<Bone>& bones = shapes_[known_[shell]].bones;
    for (size_t end = 0; end < std::min<size_t>(shapes_[shell].ends.size(), 255); ++end)
      for (const Bone& bone : bones) {
        Contact c = contact(shell, static_cast<int>(end), static_cast<uint32_t>(known_[shell]), bone);
        if (c.cost < best.cost) best = c;
      }
    best.cost = -0.5;
    return best;
  }

  void find_contacts() {
    std::vector<Eigen::AlignedBox3d> boxes;
    for (uint32_t s = 0; s < shapes_.size(); ++s) {
      if (!is_branch(s)) continue;
      for (const Bone& bone : shapes_[s].bones) {
        const Vec3 r = Vec3::Constant(std::max(bone.from_radius, bone.to_radius));
        Eigen::AlignedBox3d box(bone.from - r, bone.from + r);
        box.extend(bone.to - r), box.extend(bone.to + r);
        boxes.push_back(box), bones_.push_back({s, &bone});
      }
    }
    Eigen::AlignedBox3d all;
    for (const auto& box : boxes) all.extend(box);
    for (const ShellShape& shape : shapes_)
      for (const ShellEnd& end : shape.ends) all.extend(end.point);
    const double widest = all.diagonal().norm();
    const BoxTree tree(std::move(boxes));
    std::vector<std::vector<Contact>> of_shell(shapes_.size());
    parallel_for(
        shapes_.size(), 0,
        [&](size_t s, unsigned) {
          const auto shell = static_cast<uint32_t>(s);
          if (known_[s] >= 0) return of_shell[s].push_back(known_contact(shell));
          for (size_t end = 0; end < std::min<size_t>(shapes_[s].ends.size(), 255); ++end) {
            const ShellEnd& e = shapes_[s].ends[end];
            std::vector<Contact> found;
            for (double reach = std::max(3 * e.radius, 1e-6 * widest); found.empty() && reach <= 4 * widest;
                 reach *= 2)
              tree.near(e.point, reach, [&](uint32_t bone) {
                if (bones_[bone].first != shell)
                  found.push_back(
                      contact(shell, static_cast<int>(end), bones_[bone].first, *bones_[bone].second));
              });
            std::sort(found.begin(), found.end(), [](const Contact& a, const Contact& b) {
              return std::tie(a.cost, a.parent, a.along) < std::tie(b.cost, b.parent, b.along);
            });
            if (found.size() > kMostContacts) found.resize(kMostContacts);
            of_shell[s].insert(of_shell[s].end(), found.begin(), found.end());
          }
        },
        64);
    first_.push_back(0);
    for (const auto& found : of_shell) {
      contacts_.insert(contacts_.end(), found.begin(), found.end());
      first_.push_back(static_cast<uint32_t>(contacts_.size()));
    }
    carried_.resize(shapes_.size());
    for (uint32_t c = 0; c < contacts_.size(); ++c) carried_[contacts_[c].parent].push_back(c);
  }

  /// With the parent placed: what begins where it begins is rather its sibling.
  double full_cost(const Contact& c) const {
    const double root = shapes_[c.parent].ends[placed_[c.parent].end].along;
    const double sibling = is_branch(c.child) ? 1.2 : 0.1;  // a leaf may sit in the fork itself
    return c.cost + sibling * std::max(0.0, 1 - std::abs(c.along - root) / (0.5 * c.radius));
  }

  void grow_from_ground() {
    struct Offer {
      double cost;
      uint32_t shell;
      int end, parent;
      bool operator>(const Offer& o) const {
        return std::tie(cost, shell, end, parent) > std::tie(o.cost, o.shell, o.end, o.parent);
      }
    };
    std::priority_queue<Offer, std::vector<Offer>, std::greater<>> offers;
    Offer first{kInfinity, 0, 0, -1};
    for (uint32_t s = 0; s < shapes_.size(); ++s)
      for (int end = 0; is_branch(s) && end < static_cast<int>(shapes_[s].ends.size()); ++end) {
        offers.push({ground_cost(s, end), s, end, -1});
        if (ground_cost(s, end) < first.cost) first = {ground_cost(s, end), s, end, -1};
      }
    first.cost = -1;  // the trunk, before anything can claim it
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
    for (uint32_t s = 0; s < shapes_.size(); ++s) {
      if (placed_[s].cost == -1) continue;
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
    if (known_[shell] >= 0) return 1;
    double own = placed.cost;
    if (placed.cost == -1) own = ground_cost(shell, placed.end);
    double others = 0;
    const auto rival = [&](double cost) {
      others += std::exp(std::clamp((own - cost) / kTemperature, -50.0, 50.0));
    };
    for (int end = 0; placed.parent >= 0 && end < static_cast<int>(shapes_[shell].ends.size()); ++end)
      if (is_branch(shell)) rival(ground_cost(shell, end));
    std::vector<std::pair<uint32_t, double>> best;  // per parent
    for (uint32_t c = first_[shell]; placed.cost != -1 && c < first_[shell + 1]; ++c)
      if (static_cast<int>(contacts_[c].parent) != placed.parent && !grows_from(contacts_[c].parent, shell))
        best.push_back({contacts_[c].parent, full_cost(contacts_[c])});
    std::sort(best.begin(), best.end());
    for (size_t i = 0; i < best.size(); ++i)
      if (i == 0 || best[i].first != best[i - 1].first) rival(best[i].second);
    return std::exp(-0.6 * std::max(0.0, own - 0.6)) / (1 + others);
  }

  const std::vector<ShellShape>& shapes_;
  const std::vector<DomainKind>& kinds_;
  const std::vector<int>& known_;  // parents, -1 where they are to be found
  const Vec3 up_;
  std::vector<Placed> placed_;
  std::vector<double> thickest_end_;  // per shell
  double lowest_ = 0, height_ = 1, thickest_ = 0;
  double thin_ = 1;                                      // radius that a tenth of the branches is below
  std::vector<std::pair<uint32_t, const Bone*>> bones_;  // shell and bone
  std::vector<Contact> contacts_;                        // by child
  std::vector<uint32_t> first_;                          // per shell, its first contact
  std::vector<std::vector<uint32_t>> carried_;           // per shell, the contacts in which it is the parent
};

}  // namespace

std::vector<Growth> find_growth(const std::vector<ShellShape>& shapes, const std::vector<DomainKind>& kinds,
                                const std::vector<int>& known_parents, const Vec3& up) {
  require(shapes.size() == kinds.size() && shapes.size() == known_parents.size(),
          "find_growth: one of each per shell");
  return Grower(shapes, kinds, known_parents, up).grow();
}

}  // namespace liana
