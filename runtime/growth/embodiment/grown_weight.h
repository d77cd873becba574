// Wood that grows under weight is shaped by it: a climber at rest stands as it grew.
#pragma once

#include "runtime/sim/model/plant.h"

namespace liana {

/// How a particle is turned when all joints are at their rest angles, and the weight beyond it.
struct RestPose {
  Quat orientation = Quat::Identity();
  Vec3 force = Vec3::Zero();   ///< N
  Vec3 moment = Vec3::Zero();  ///< N·m, about its centre
};

/// Sets every joint's rest load to the weight beyond it, in the plant's rest pose (all joints at their rest
/// angles), whatever its present one: swaying, pushed or pulled plants come back to where they grew. Anchors
/// carry nothing at rest. gravity in m/s². `rest` is working memory.
void carry_grown_weight(Plant& plant, const Vec3& gravity, std::vector<RestPose>& rest);

/// In a joint's frame, as Joint's rest_force and rest_moment.
struct JointLoad {
  Vec3 force, moment;  ///< N, N·m

  template <class Archive>
  void persist(Archive& a) {
    a(force, moment);
  }
};

/// What the weight beyond each joint, where it is now, asks of the joint beyond its rest load.
void uncarried_weight(const Plant& plant, const Vec3& gravity, std::vector<JointLoad>& loads);

}  // namespace liana
