#include "runtime/world/scene/obstacle_motion.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "mesher/base/fixed_math.h"
#include "runtime/sim/model/rotation.h"

namespace liana {
namespace {

struct Place {
  Vec3 offset;
  Quat rotation;
};

Place along_keys(const std::vector<ObstacleMotion::Key>& keys, double time) {
  if (keys.empty()) return {Vec3::Zero(), Quat::Identity()};
  const auto next = std::upper_bound(keys.begin(), keys.end(), time,
                                     [](double t, const ObstacleMotion::Key& key) { return t < key.time; });
  if (next == keys.begin()) return {keys.front().offset, keys.front().rotation};
  const ObstacleMotion::Key& last = *(next - 1);
  if (next == keys.end()) return {last.offset, last.rotation};
  const double t = (time - last.time) / (next->time - last.time), eased = t * t * (3 - 2 * t);
  return {last.offset + eased * (next->offset - last.offset),
          rotation_between(last.rotation, next->rotation, eased)};
}

Place place_at(const ObstacleMotion& motion, double time) {
  const double gone = std::clamp(time, motion.start, motion.stop) - motion.start;
  Place place = along_keys(motion.keys, time);
  place.offset += gone * motion.velocity + fixed::sin(2 * kPi * gone / motion.period) * motion.swing;
  const double angle = gone * motion.turn.norm();
  if (angle > 0) place.rotation = rotation_about(motion.turn.normalized(), angle) * place.rotation;
  return place;
}

}  // namespace

ObstaclePose ObstacleMotion::between(double from, double to) const {
  const Place before = place_at(*this, from), now = place_at(*this, to);
  ObstaclePose pose;
  pose.rotation = now.rotation;
  pose.centre = pivot + now.offset;
  pose.position = pose.centre - now.rotation * pivot;
  if (to > from) {
    pose.velocity = (now.offset - before.offset) / (to - from);
    pose.angular_velocity = rotation_log(now.rotation * before.rotation.conjugate()).vector / (to - from);
  }
  return pose;
}

Quat rotation_from_degrees(const Vec3& degrees) {
  const Vec3 r = degrees * kPi / 180;
  return rotation_about(Vec3::UnitZ(), r.z()) * rotation_about(Vec3::UnitY(), r.y()) *
         rotation_about(Vec3::UnitX(), r.x());
}

ObstacleMotion read_obstacle_motion(const TomlTable& table, const Vec3& pivot) {
  constexpr double kFastest = 50, kFastestTurn = 3600;  // m/s, degrees/s
  ObstacleMotion motion;
  motion.pivot = table.vector_or("pivot", pivot);
  motion.velocity = table.vector_or("velocity", Vec3::Zero());
  if (motion.velocity.norm() > kFastest) table.fail("velocity", fmt::format("is above {} m/s", kFastest));
  motion.swing = table.vector_or("swing", Vec3::Zero());
  motion.period = table.number_or("period", 4, 0.05, 1e6);
  if (2 * kPi * motion.swing.norm() / motion.period > kFastest)
    table.fail("swing", fmt::format("over this period is faster than {} m/s", kFastest));
  const Vec3 turn = table.vector_or("turn", Vec3::Zero());
  if (turn.norm() > kFastestTurn) table.fail("turn", fmt::format("is above {} degrees/s", kFastestTurn));
  motion.turn = turn * kPi / 180;
  motion.start = table.number_or("start", 0, 0, 1e6);
  motion.stop = table.number_or("stop", 1e9, motion.start, 1e9);
  for (const TomlTable& entry : table.tables("keyframe")) {
    ObstacleMotion::Key key{entry.number("time", 0, 1e6), entry.vector_or("offset", Vec3::Zero()),
                            rotation_from_degrees(entry.vector_or("rotate", Vec3::Zero()))};
    if (!motion.keys.empty()) {
      const double seconds = key.time - motion.keys.back().time;
      if (!(seconds > 0)) entry.fail("time", "must be later than that of the keyframe before");
      if ((key.offset - motion.keys.back().offset).norm() > kFastest / 1.5 * seconds)
        entry.fail("offset", fmt::format("is reached faster than {} m/s", kFastest));
    }
    entry.refuse_unknown_keys();
    motion.keys.push_back(key);
  }
  table.refuse_unknown_keys();
  return motion;
}

}  // namespace liana
