// Equal runs have equal bits: threads, kernels, replays, and (where the mathematics library is the same)
// compilers.
#include <gtest/gtest.h>

#include <cmath>

#include "mesher/base/hash.h"
#include "runtime/sim/plant_from_bake.h"
#include "runtime/sim/state_hash.h"
#include "tests/support/abused_garden.h"
#include "tests/support/synthetic_bake.h"

namespace liana {
namespace {

TEST(Determinism, OneHashForOneThreadAndForTwoWhateverIsDone) {
  test::AbusedGarden one(3, 5, 1), two(3, 5, 2), other(4, 5, 2);
  for (int i = 0; i < 4; ++i) {
    one.spell(), two.spell(), other.spell();
    ASSERT_EQ(one.hash(), two.hash()) << "spell " << i;
  }
  EXPECT_NE(one.hash(), other.hash()) << "the hash sees what was done";
}

// What a user did to a plant, step by step.
struct Session {
  struct Input {
    std::vector<WorldSpring> grabs;
    std::vector<Wrench> wind;
    ParticleId struck;  // invalid: nobody
    Vec3 blow = Vec3::Zero();
  };
  std::vector<Input> inputs;
  std::vector<uint64_t> hashes;  // after each step
};

Plant start() {
  return make_plant(test::synthetic_bake({.branches = 3}));
}

uint64_t take(Plant& plant, PlantStepper& stepper, const Session::Input& input) {
  if (input.struck.valid()) plant.motion[input.struck.index()].velocity += input.blow;
  stepper.step(plant, input.wind, input.grabs, {});
  return state_hash(plant);
}

TEST(Determinism, RecordedSessionReplayedHasTheSameHashAtEveryStep) {
  Session session;
  Random random(5, "trust/session");
  {  // played live: where the grab pulls depends on where the plant is
    Plant plant = start();
    PlantStepper stepper;
    for (int i = 0; i < 300; ++i) {
      Session::Input input;
      if (i % 100 > 30 && i % 100 < 70) {
        const size_t k = plant.motion.size() - 1 - static_cast<size_t>(i / 100);
        input.grabs.push_back({.particle = ParticleId(k),
                               .target = plant.motion[k].position + Vec3(0.02, 0.01, -0.02),
                               .stiffness = 200 * Mat3::Identity(),
                               .damping = Mat3::Identity()});
      }
      if (i > 150) input.wind.assign(plant.motion.size(), {.force = {2e-3 * random.uniform(), 0, 1e-3}});
      if (i % 60 == 10) {
        input.struck = ParticleId(random.next() % plant.motion.size());
        input.blow = Vec3(random.uniform(-30, 30), 5, random.uniform(-30, 30));
      }
      session.hashes.push_back(take(plant, stepper, input));
      session.inputs.push_back(std::move(input));
    }
  }
  Plant plant = start();
  PlantStepper stepper;
  for (size_t i = 0; i < session.inputs.size(); ++i)
    ASSERT_EQ(take(plant, stepper, session.inputs[i]), session.hashes[i]) << "step " << i;
}

// Functions of the mathematics library are the one thing that differs between machines.
uint64_t library_fingerprint() {
  std::vector<double> values;
  for (int i = 1; i < 2000; ++i) {
    const double x = 0.00317 * i;
    for (const double y : {std::sin(x), std::cos(x), std::atan2(x, 1 - x), std::exp(-x), std::pow(x, -0.59),
                           std::log(x), std::tan(x), std::acos(x / 7), std::hypot(x, 1.0)})
      values.push_back(y);
  }
  return hash_bytes(values.data(), values.size() * sizeof(double), 0);
}

// One number for GCC and Clang, with and without optimisation, with and without AVX2. When the step is meant
// to compute something else from now on, put the new number here.
TEST(Determinism, GoldenHash) {
  constexpr uint64_t kLibrary = 0x9778c5ebe0029478, kGolden = 0x6c61d403bd07515d;
  Plant plant = start();
  PlantStepper stepper;
  Session::Input input;
  for (int i = 0; i < 200; ++i) {
    input.struck = i % 50 == 0 ? ParticleId(plant.motion.size() / 2) : ParticleId();
    input.blow = Vec3(20, 3, -10);
    take(plant, stepper, input);
  }
  if (library_fingerprint() != kLibrary)
    GTEST_SKIP() << "another mathematics library: " << std::hex << library_fingerprint() << ", hash "
                 << state_hash(plant);
  EXPECT_EQ(state_hash(plant), kGolden) << std::hex << "0x" << state_hash(plant);
}

}  // namespace
}  // namespace liana
