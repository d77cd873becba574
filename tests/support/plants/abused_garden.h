// A small garden under random abuse, a function of its seed alone: grabs, shakes, impulses, jumping supports,
// storms, cuts, steps of any length, and quiet spells in which it may only calm down.
#pragma once

#include <string>
#include <vector>

#include "mesher/base/random.h"
#include "runtime/sim/step/time_step.h"

namespace liana::test {

struct GardenReport {
  size_t steps = 0, redone = 0, projected = 0, lost = 0, cuts = 0, spells = 0;
  double seconds = 0;     ///< simulated
  double top_speed = 0;   ///< m/s
  double top_growth = 0;  ///< of the energy in a quiet spell, over what it began with
  std::string broken;     ///< which invariant failed first, and when; empty when all held
};

class AbusedGarden {
 public:
  AbusedGarden(uint64_t seed, size_t plants, unsigned threads);

  /// One spell of abuse (1.5 s of the abusive's time or so), then a quiet one.
  void spell();

  const GardenReport& report() const { return report_; }
  uint64_t hash() const;

 private:
  enum class Abuse { Impulse, Teleport, Shake, Storm, Jitter, Cut, Pinch };

  struct Victim {
    explicit Victim(uint64_t seed);

    Plant plant;
    Random random;
    PlantStepper stepper;
    std::vector<Plant> pieces;  // cut off, falling
    std::vector<PlantStepper> piece_steppers;
    Abuse abuse = Abuse::Impulse;
    double rest_energy = 0;
    std::vector<WorldSpring> springs;
    GardenReport report;
    std::string broken;
  };

  void torment(Victim& victim);
  void rest(Victim& victim);
  void act(Victim& victim, int step);
  void advance(Victim& victim, double dt);
  void cut(Victim& victim);

  unsigned threads_;
  std::vector<Victim> victims_;
  GardenReport report_;
};

}  // namespace liana::test
