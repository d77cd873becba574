#include "runtime/world/scene/scene_file.h"

#include <fmt/core.h>

#include "materials/law/toml_table.h"
#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "mesher/geometry/weld.h"
#include "mesher/io/plant_file.h"
#include "runtime/growth/climber_parameters.h"
#include "runtime/obstacles/box_mesh.h"
#include "runtime/world/scene/scene_events.h"
#include "runtime/world/scene/scene_wind.h"

namespace liana {
namespace {

constexpr double kFar = 1e4;  // m: nothing in a scene is farther from the origin or larger

std::filesystem::path existing_file(const TomlTable& table, const std::string& key) {
  const std::filesystem::path path = table.file().parent_path() / table.text(key);
  if (!std::filesystem::is_regular_file(path)) {
    const bool bake = path.extension() == ".bake";
    table.fail(key, fmt::format("names {}, which does not exist", path.string()),
               bake ? "make it with: liana bake PLANT.glb --species NAME -o " + path.string()
                    : "paths are relative to the scene file");
  }
  return path;
}

/// Any glTF, OBJ or PLY file, all its meshes as one.
Mesh read_obstacle_mesh(const std::filesystem::path& path) {
  Mesh all;
  const std::string extension = path.extension().string();
  if (extension == ".obj" || extension == ".ply") {
    const TriangleSoup soup = (extension == ".obj" ? parse_obj : parse_ply)(read_file(path), path.string());
    return weld({soup.positions, soup.triangles});
  }
  for (const Domain& part : read_plant(path).domains) {
    const auto first = static_cast<uint32_t>(all.positions.size());
    all.positions.insert(all.positions.end(), part.surface.positions.begin(), part.surface.positions.end());
    for (const Triangle& t : part.surface.triangles)
      all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return all;
}

ContactMaterial read_contact_material(const TomlTable& table) {
  const ContactMaterial usual;
  const char* restitution = table.has("elasticity") ? "elasticity" : "restitution";  // its old name
  return {table.number_or("friction", usual.friction, 0, 1),
          table.number_or(restitution, usual.restitution, 0, 1)};
}

/// Scales, rotates and moves a mesh about a point. Exact: its distance field is that of the moved mesh.
void transform(const TomlTable& table, const Vec3& about, const Vec3& way, Mesh& mesh) {
  const Vec3 scale = table.vector_or("scale", Vec3::Ones());
  if (!(scale.minCoeff() >= 1e-4 && scale.maxCoeff() <= kFar))
    table.fail("scale", fmt::format("must lie between 0.0001 and {} in every direction", kFar));
  const Quat rotation = rotation_from_degrees(table.vector_or("rotate", Vec3::Zero()));
  for (Vec3& p : mesh.positions) p = about + way + rotation * scale.cwiseProduct(p - about);
}

SceneObstacle read_obstacle(const TomlTable& table) {
  SceneObstacle obstacle;
  obstacle.name = table.text_or("name", "obstacle");
  obstacle.color = table.vector_or("color", {0.55, 0.5, 0.45});
  const std::string look = table.text_or("look", "plain");
  if (look != "plain" && look != "bricks") table.fail("look", "must be \"plain\" or \"bricks\"");
  obstacle.bricks = look == "bricks";

  obstacle.contact_material = read_contact_material(table);
  if (table.has("thickness")) obstacle.thickness = table.number("thickness", 5e-4, 1);
  Vec3 pivot = Vec3::Zero();

  if (const auto box = table.table("box")) {
    const Vec3 centre = box->vector("center"), size = box->vector("size");
    if (!(size.minCoeff() >= 1e-3 && size.maxCoeff() <= kFar))
      box->fail("size", fmt::format("must lie between 0.001 and {} m in every direction", kFar));
    box->refuse_unknown_keys();
    obstacle.mesh = box_mesh(centre - size / 2, centre + size / 2);
    pivot = centre;
    transform(table, centre, Vec3::Zero(), obstacle.mesh);
  } else if (table.has("mesh")) {
    obstacle.mesh = read_obstacle_mesh(existing_file(table, "mesh"));
    pivot = table.vector_or("position", Vec3::Zero());
    transform(table, Vec3::Zero(), pivot, obstacle.mesh);
  } else {
    table.fail("box", "or 'mesh' is needed to give the obstacle a shape",
               "box = { center = [0, 1.5, -0.1], size = [4, 3, 0.2] }");
  }
  if (const auto motion = table.table("motion")) obstacle.motion = read_obstacle_motion(*motion, pivot);
  table.refuse_unknown_keys();
  return obstacle;
}

ScenePlant read_plant_entry(const TomlTable& table) {
  ScenePlant plant{existing_file(table, "bake"), table.vector_or("position", Vec3::Zero()),
                   table.number_or("yaw", 0, -360, 360) * kPi / 180, table.number_or("breaking", 0, 0, 1)};
  table.refuse_unknown_keys();
  return plant;
}

SceneClimber read_climber(const TomlTable& table) {
  SceneClimber climber;
  if (table.has("bake"))
    climber.bake = existing_file(table, "bake");
  else
    climber.species = table.text_or("species", "ivy");
  climber.position = table.vector("position");
  climber.growth_speed = table.number_or("growth_speed", climber.growth_speed, 0, 4);
  climber.max_particles = static_cast<size_t>(
      table.integer_or("max_particles", static_cast<int64_t>(climber.max_particles), 1, 1'000'000));
  climber.breaking = table.number_or("breaking", climber.breaking, 0, 1);
  climber.stiffness = table.number_or("stiffness", climber.stiffness, 1e-3, 1e3);
  climber.weight_grown_in = table.number_or("weight_grown_in", climber.weight_grown_in, 0, 1);
  climber.first_shoots = static_cast<unsigned>(table.integer_or("first_shoots", climber.first_shoots, 1, 64));
  climber.longest_free = table.number_or("longest_free", climber.longest_free, 0, 5);
  table.refuse_unknown_keys();
  return climber;
}

}  // namespace

Scene read_scene(const std::filesystem::path& path) {
  const TomlTable table = TomlTable::read(path);
  Scene scene;
  scene.file = path;
  scene.title = table.text_or("title", path.stem().string());
  scene.seed = static_cast<uint64_t>(table.integer_or("seed", 1, 0, int64_t{1} << 53));
  scene.time_step = table.number_or("time_step", scene.time_step, 1e-4, 0.1);
  scene.seconds = table.number_or("seconds", scene.seconds, 0, 86400);
  scene.gravity = table.vector_or("gravity", scene.gravity);
  const std::string solver = table.text_or("solver", "direct");
  if (solver != "direct" && solver != "shape-matching")
    table.fail("solver", "must be \"direct\" or \"shape-matching\"",
               "only \"direct\" moves as baked; \"shape-matching\" is the scheme of [Haedrich17]");
  scene.solver = solver == "direct" ? Solver::Direct : Solver::ShapeMatching;
  if (const auto sun = table.table("sun")) {
    scene.to_sun = sun->vector("direction");
    if (scene.to_sun.norm() < 1e-9) sun->fail("direction", "must not be zero");
    sun->refuse_unknown_keys();
  }
  if (const auto wind = table.table("wind")) scene.wind = read_scene_wind(*wind, scene.seed);
  if (const auto camera = table.table("camera")) {
    scene.camera = SceneCamera{camera->vector("eye"), camera->vector("target"),
                               camera->number_or("vertical_angle", 40, 5, 120) * kPi / 180};
    if ((scene.camera->eye - scene.camera->target).norm() < 1e-6)
      camera->fail("eye", "and 'target' must not coincide");
    camera->refuse_unknown_keys();
  }
  scene.plant_contacts = table.flag_or("plant_contacts", false);
  if (const auto touch = table.table("plant_touch")) {
    if (!scene.plant_contacts)
      touch->fail("friction", "means nothing while plants do not touch each other",
                  "set plant_contacts = true");
    scene.plant_contact_material = read_contact_material(*touch);
    touch->refuse_unknown_keys();
  }
  for (const TomlTable& entry : table.tables("obstacle")) scene.obstacles.push_back(read_obstacle(entry));
  for (const TomlTable& entry : table.tables("plant")) scene.plants.push_back(read_plant_entry(entry));
  for (const TomlTable& entry : table.tables("climber")) scene.climbers.push_back(read_climber(entry));
  read_scene_events(table, scene);
  table.refuse_unknown_keys();
  if (scene.plants.empty() && scene.climbers.empty())
    throw Error(Error::Kind::Input, path.string() + ": the scene has no [[plant]] and no [[climber]]",
                "add for example: [[climber]] species = \"ivy\" position = [0, 0, 0.05]");
  return scene;
}

}  // namespace liana
