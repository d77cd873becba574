// grow_on_a_mesh MESH.obj SPECIES.toml: what a game does while it loads: an ivy climbs a mesh for 30 s of its
// own time.
#include <cstdio>

#include "materials/law/species_file.h"
#include "mesher/base/files.h"
#include "mesher/io/triangle_soup.h"
#include "runtime/growth/climber.h"
#include "runtime/sim/contact/contact_step.h"

int main(int argc, char** argv) {
  using namespace liana;
  if (argc != 3) return std::fprintf(stderr, "grow_on_a_mesh MESH.obj SPECIES.toml\n"), 2;
  const TriangleSoup soup = parse_obj(read_file(argv[1]), argv[1]);
  const SdfObstacle solid(Mesh{soup.positions, soup.triangles});
  const SdfObstacle* solids[] = {&solid};

  Plant plant;
  Climber climber({}, read_species(argv[2]), Vec3(0, 0, 0.12), /*random_seed=*/7);
  ContactStepper stepper;
  GrowthReport grown;
  for (double t = 0; t < 30; t += plant.scheme.dt) {
    std::vector<WorldSpring> springs;
    grown = climber.grow(plant, solids, /*to_sun=*/Vec3(0.4, 0.8, 0.45), plant.scheme.dt);
    stepper.step(plant, {solids, /*ground=*/0.0}, {}, springs, {.dt = plant.scheme.dt});
  }
  std::printf("%zu particles, %zu leaves, %zu anchors\n", plant.particles.size(), grown.leaves,
              grown.anchors);
}
