// step_a_bake FILE.bake: loads a bake, pushes its highest particle for a second and prints where that goes.
#include <algorithm>
#include <cstdio>

#include "materials/bake/bake_file.h"
#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/step/time_step.h"

int main(int argc, char** argv) {
  using namespace liana;
  if (argc != 2) return std::fprintf(stderr, "step_a_bake FILE.bake\n"), 2;
  Plant plant = make_plant(read_bake(argv[1]));
  const auto lower = [](const Motion& a, const Motion& b) { return a.position.y() < b.position.y(); };
  const auto tip = std::max_element(plant.motion.begin(), plant.motion.end(), lower) - plant.motion.begin();

  PlantStepper stepper;
  std::vector<Wrench> push(plant.particles.size());
  for (int step = 0; step <= 120; ++step) {
    const Vec3& x = plant.motion[tip].position;
    if (step % 4 == 0)
      std::printf("%.1f s  %+.4f %+.4f %+.4f m\n", step * plant.scheme.dt, x.x(), x.y(), x.z());
    push[tip].force.x() = step < 40 ? 0.2 * 9.81 * plant.particles[tip].mass : 0;  // N
    stepper.step(plant, push, {}, {.dt = plant.scheme.dt});
  }
}
