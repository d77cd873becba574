#include "mesher/shells/contact_costs.h"

#include <algorithm>
#include <cmath>

#include "mesher/base/parallel.h"
#include "mesher/geometry/box_tree.h"

namespace liana {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kKnownCost = -0.5;   // below all that is found, above the trunk's
constexpr size_t kMostContacts = 24;  // of one end
constexpr size_t kMostEnds = 255;     // of one shell

}  // namespace

ContactCosts::ContactCosts(const ShellSet& shells, const HierarchyWeights& weights)
    : shells_(shells), weights_(weights), thickest_end_(shells.shapes.size(), 0), lowest_(kInfinity) {
  double highest = -kInfinity;
  std::vector<double> radii;
  for (size_t s = 0; s < shells.shapes.size(); ++s) {
    for (const ShellEnd& end : shells.shapes[s].ends) {
      thickest_end_[s] = std::max(thickest_end_[s], end.radius);
      highest = std::max(highest, end.point.dot(shells.up));
      if (shells.is_branch(s)) lowest_ = std::min(lowest_, end.point.dot(shells.up));
    }
    if (shells.is_branch(s))
      thickest_ = std::max(thickest_, thickest_end_[s]), radii.push_back(thickest_end_[s]);
  }
  if (radii.empty()) return;
  const auto tenth = radii.begin() + static_cast<ptrdiff_t>(radii.size() / 10);
  std::nth_element(radii.begin(), tenth, radii.end());
  thin_ = std::max(*tenth, 1e-9 * thickest_);
  height_ = std::max(highest - lowest_, 1e-300);
}

double ContactCosts::thin_end(uint32_t shell, int end) const {
  if (!shells_.is_branch(shell)) return 0;
  const double radius = std::max(shells_.shapes[shell].ends[end].radius, 1e-9 * thickest_);
  return weights_.thin_end * std::log(std::max(1.0, thickest_end_[shell] / radius));
}

double ContactCosts::ground(uint32_t shell, int end) const {
  if (!shells_.is_branch(shell) || shells_.known_parents[shell] >= 0) return kInfinity;
  const ShellEnd& e = shells_.shapes[shell].ends[end];
  const double height = (e.point.dot(shells_.up) - lowest_) / height_;
  return weights_.ground + weights_.ground_height * std::max(0.0, height - weights_.ground_level) +
         thin_end(shell, end) +
         weights_.ground_thinner * std::log(thickest_ / std::max(thickest_end_[shell], 1e-9 * thickest_));
}

Contact ContactCosts::contact(uint32_t shell, int end, uint32_t parent, const Bone& b) const {
  const ShellEnd& e = shells_.shapes[shell].ends[end];
  const Vec3 axis = b.to - b.from;
  const double t = std::clamp((e.point - b.from).dot(axis) / std::max(axis.squaredNorm(), 1e-300), 0.0, 1.0);
  Contact c{shell, parent, static_cast<uint8_t>(end), 0, 0, 0};
  c.along = b.from_along + t * (b.to_along - b.from_along);
  c.radius = std::max(b.from_radius + t * (b.to_radius - b.from_radius), 1e-9 * thickest_);
  const double off_axis = (e.point - b.from - t * axis).norm();
  const HierarchyWeights& w = weights_;
  if (shells_.is_branch(shell)) {
    const double gap = std::max(0.0, off_axis - c.radius),
                 near = std::max({e.radius, w.near * c.radius, 1e-300});
    c.cost = w.gap * std::log1p(gap / near) + w.off_axis * std::min(off_axis / c.radius, 1.0) +
             thin_end(shell, end) +
             w.thicker * std::log(std::max(1.0, e.radius / (w.thicker_from * c.radius)));
  } else {
    // A leaf begins on the bark or on the middle line, and rather on thin shoots.
    const double gap = std::min(std::abs(off_axis - c.radius), off_axis);
    const double near = std::max(w.leaf_near * std::sqrt(shells_.shapes[shell].area), 1e-300);
    c.cost = w.leaf_gap * std::log1p(gap / near) + w.leaf_doubt * e.doubt +
             w.leaf_thick * std::log(std::max(1.0, c.radius / thin_));
  }
  return c;
}

Contact ContactCosts::known_contact(uint32_t shell) const {
  const auto parent = static_cast<uint32_t>(shells_.known_parents[shell]);
  Contact best{};
  best.cost = kInfinity;
  const std::vector<Bone>& bones = shells_.shapes[parent].bones;
  for (size_t end = 0; end < std::min(shells_.shapes[shell].ends.size(), kMostEnds); ++end)
    for (const Bone& bone : bones) {
      const Contact c = contact(shell, static_cast<int>(end), parent, bone);
      if (c.cost < best.cost) best = c;
    }
  best.cost = kKnownCost;
  return best;
}

double ContactCosts::with_root(const Contact& c, double root) const {
  const double sibling = shells_.is_branch(c.child) ? weights_.sibling : weights_.leaf_sibling;
  return c.cost + sibling * std::max(0.0, 1 - std::abs(c.along - root) / (weights_.sibling_reach * c.radius));
}

namespace {

/// All bones of all branches, and who lies near them.
class BoneSearch {
 public:
  explicit BoneSearch(const ShellSet& shells) : tree_(collect(shells)) {
    for (const ShellShape& shape : shells.shapes)
      for (const ShellEnd& end : shape.ends) all_.extend(end.point);
  }

  /// The cheapest contacts of one end.
  std::vector<Contact> of_end(const ShellSet& shells, const ContactCosts& costs, uint32_t shell,
                              int end) const {
    const ShellEnd& e = shells.shapes[shell].ends[end];
    const double widest = all_.diagonal().norm();
    std::vector<Contact> found;
    for (double reach = std::max(3 * e.radius, 1e-6 * widest); found.empty() && reach <= 4 * widest;
         reach *= 2)
      tree_.near(e.point, reach, [&](uint32_t bone) {
        if (bones_[bone].first != shell)
          found.push_back(costs.contact(shell, end, bones_[bone].first, *bones_[bone].second));
      });
    std::sort(found.begin(), found.end(), [](const Contact& a, const Contact& b) {
      return std::tie(a.cost, a.parent, a.along) < std::tie(b.cost, b.parent, b.along);
    });
    if (found.size() > kMostContacts) found.resize(kMostContacts);
    return found;
  }

 private:
  std::vector<Eigen::AlignedBox3d> collect(const ShellSet& shells) {
    std::vector<Eigen::AlignedBox3d> boxes;
    for (uint32_t s = 0; s < shells.shapes.size(); ++s) {
      if (!shells.is_branch(s)) continue;
      for (const Bone& bone : shells.shapes[s].bones) {
        const Vec3 r = Vec3::Constant(std::max(bone.from_radius, bone.to_radius));
        Eigen::AlignedBox3d box(bone.from - r, bone.from + r);
        box.extend(bone.to - r), box.extend(bone.to + r);
        boxes.push_back(box), bones_.push_back({s, &bone});
        all_.extend(box);
      }
    }
    return boxes;
  }

  std::vector<std::pair<uint32_t, const Bone*>> bones_;  // shell and bone
  Eigen::AlignedBox3d all_;
  BoxTree tree_;  // last: collect() fills the others
};

}  // namespace

std::vector<Contact> find_contacts(const ShellSet& shells, const ContactCosts& costs) {
  const BoneSearch search(shells);
  std::vector<std::vector<Contact>> of_shell(shells.shapes.size());
  parallel_for(
      of_shell.size(), 0,
      [&](size_t s, unsigned) {
        const auto shell = static_cast<uint32_t>(s);
        if (shells.known_parents[s] >= 0) return of_shell[s].push_back(costs.known_contact(shell));
        for (size_t end = 0; end < std::min(shells.shapes[s].ends.size(), kMostEnds); ++end) {
          const std::vector<Contact> found = search.of_end(shells, costs, shell, static_cast<int>(end));
          of_shell[s].insert(of_shell[s].end(), found.begin(), found.end());
        }
      },
      64);
  std::vector<Contact> contacts;
  for (const std::vector<Contact>& found : of_shell)
    contacts.insert(contacts.end(), found.begin(), found.end());
  return contacts;
}

}  // namespace liana
