#include "runtime/world/scene/scene_events.h"

namespace liana {
namespace {

constexpr double kLongest = 86400;  // s

ScenePoint read_point(const TomlTable& table, const Scene& scene) {
  ScenePoint point;
  point.climber = table.has("climber");
  if (point.climber && table.has("plant")) table.fail("climber", "and 'plant' are both given", "give one");
  const char* key = point.climber ? "climber" : "plant";
  const size_t count = point.climber ? scene.climbers.size() : scene.plants.size();
  if (count == 0) table.fail(key, "is none: the scene has no such thing");
  point.index = static_cast<size_t>(table.integer_or(key, 0, 0, static_cast<int64_t>(count) - 1));
  if (table.has("domain") == table.has("at"))
    table.fail("at", "or 'domain' is needed, and only one of them", "at = [0, 1.2, 0]");
  if (table.has("at")) {
    point.at = table.vector("at");
  } else {
    if (point.climber) table.fail("domain", "is not something a climber has", "give at = [x, y, z]");
    point.domain = table.text("domain");
    point.along = table.number_or("along", 0, 0, 1);
  }
  return point;
}

SceneImpulse read_impulse(const TomlTable& table, size_t plants) {
  constexpr double kFastest = 100;  // m/s
  if (plants == 0)
    table.fail("plant", "is none: the scene has no [[plant]] to strike", "add [[plant]] bake = \"...\"");
  SceneImpulse impulse{static_cast<size_t>(table.integer_or("plant", 0, 0, static_cast<int64_t>(plants) - 1)),
                       table.text("domain"), table.number_or("time", 0, 0, kLongest),
                       table.vector("velocity")};
  if (impulse.velocity.norm() > kFastest) table.fail("velocity", "is above 100 m/s");
  table.refuse_unknown_keys();
  return impulse;
}

SceneGrab read_grab(const TomlTable& table, const Scene& scene) {
  SceneGrab grab{read_point(table, scene),
                 table.number_or("time", 0, 0, kLongest),
                 table.number("seconds", 1e-3, kLongest),
                 {},
                 table.number_or("strength", 1, 1e-3, 1e3)};
  for (const TomlTable& leg : table.tables("path")) {
    grab.path.push_back(leg.vector("by"));
    leg.refuse_unknown_keys();
  }
  if (grab.path.empty()) table.fail("path", "is empty", "path = [ { by = [0.5, 0, 0] } ]");
  table.refuse_unknown_keys();
  return grab;
}

}  // namespace

void read_scene_events(const TomlTable& table, Scene& scene) {
  for (const char* name : {"impulse", "pluck"})  // the second is its old name
    for (const TomlTable& entry : table.tables(name))
      scene.impulses.push_back(read_impulse(entry, scene.plants.size()));
  for (const TomlTable& entry : table.tables("cut")) {
    scene.cuts.push_back({read_point(entry, scene), entry.number_or("time", 0, 0, kLongest)});
    entry.refuse_unknown_keys();
  }
  for (const TomlTable& entry : table.tables("grab")) scene.grabs.push_back(read_grab(entry, scene));
  if (table.has("detached") && table.has("fallen"))
    table.fail("fallen", "is the old name of 'detached', which is there as well", "keep one of them");
  const auto detached = table.table(table.has("fallen") ? "fallen" : "detached");
  if (!detached) return;
  scene.detached.roots_hold = detached->number_or("roots_hold", scene.detached.roots_hold, 0, kLongest);
  scene.detached.remove_after = detached->number_or("remove_after", scene.detached.remove_after, 0, kLongest);
  detached->refuse_unknown_keys();
}

}  // namespace liana
