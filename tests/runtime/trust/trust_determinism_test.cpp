// Equal runs have equal bits: threads, kernels, replays, compilers, processors.
#include <gtest/gtest.h>

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <regex>
#include <string>

#include "mesher/base/hash.h"
#include "mesher/base/random.h"
#include "runtime/sim/calibrate/plant_from_bake.h"
#include "runtime/sim/model/state_hash.h"
#include "runtime/world/world.h"
#include "tests/support/plants/abused_garden.h"
#include "tests/support/plants/synthetic_bake.h"
#include "tests/support/scenes/busy_scene.h"

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
        input.blow = Vec3(random.uniform(-30, 30), 5, 12);
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

// Two seconds of all that there is: growth, contact of all kinds, breaking, cutting, gusts and air particles.
uint64_t world_hash() {
  const ScratchFolder folder;
  Scene scene = test::busy_scene(folder);
  scene.wind.velocity = {25, 0, -8};
  scene.plant_contacts = true;
  scene.plants[1].position = {-0.8, 0, 0.6};
  size_t touches = 0;
  World world(scene, 2);
  for (int i = 0; i < 80; ++i) {
    if (i == 10) world.cut(1, world.plant(1).branches[1].particles[1]);
    world.step();
    touches += world.report().plant_contacts;
  }
  EXPECT_GT(touches, 100u);
  const WorldReport report = world.report();
  EXPECT_GT(report.broken + report.shed, 0u);
  EXPECT_GT(report.air->emitted, 100u);
  EXPECT_GT(report.anchors, 0u);
  return world.state_hash();
}

// Every build of this test finds the same number: GCC and Clang, with and without optimisation, on processors
// with and without AVX2, AVX-512 and fused operations, with every C library. After a change that is meant to
// change the motion: put what the test prints here. Changed last when sin, exp and their like became our own
// (mesher/base/fixed_math.h; before, it was that of glibc 2.36 on processors with FMA only), random draws and
// hashes went by lineage, siblings by their own order in the solve, and obstacles and plants got one contact
// response (of the three hashes that one changed the world's alone).
constexpr uint64_t kGolden = 0xa69dce558f515aa1;

uint64_t bits_of_the_c_library() {
  uint64_t hash = 0;
  for (volatile double x = 0.001; x < 20; x = x + 0.00137)
    for (const double value : {std::sin(x), std::exp(x), std::log(x), std::pow(x, 1.7), std::atan2(x, 2)})
      hash = hash_bytes(&value, sizeof value, hash);
  return hash;
}

TEST(Determinism, OneHashForEveryKernelAndEveryBuild) {
  std::vector<uint64_t> hash;
  for (const lanes::Kernels* kernels :
       {&lanes::best_kernels(), &lanes::portable_kernels(), lanes::avx2_kernels(), lanes::avx512_kernels()}) {
    if (!kernels) continue;  // not on this processor
    Plant plant = start();
    PlantStepper stepper;
    stepper.use(*kernels);
    Session::Input input;
    for (int i = 0; i < 200; ++i) {
      input.struck = i % 50 == 0 ? ParticleId(plant.motion.size() / 2) : ParticleId();
      input.blow = Vec3(20, 3, -10);
      take(plant, stepper, input);
    }
    hash.push_back(state_hash(plant));
    EXPECT_EQ(hash.front(), hash.back());
  }
  test::AbusedGarden garden(9, 2, 1);  // redone steps, cuts, falling pieces
  for (int i = 0; i < 4; ++i) garden.spell();
  const uint64_t world = world_hash();
  const uint64_t all = hash[0] ^ garden.hash() ^ world;
  std::printf("hash of this build: 0x%016" PRIx64 " (plant %016" PRIx64 ", garden %016" PRIx64
              ", world %016" PRIx64 ")\n",
              all, hash[0], garden.hash(), world);
  std::printf("bits of the C library: %016" PRIx64 "\n", bits_of_the_c_library());
  EXPECT_EQ(all, kGolden);
}

// What the C library would do on a processor without AVX2 and FMA, it does in a process that is told so.
TEST(Determinism, OneHashWithoutFusedOperations) {
  const std::string self = std::filesystem::read_symlink("/proc/self/exe");
  const auto numbers = [&](const std::string& tunables) {
    const std::string command = "GLIBC_TUNABLES='" + tunables + "' '" + self +
                                "' --gtest_filter=Determinism.OneHashForEveryKernelAndEveryBuild";
    std::string said;
    FILE* const pipe = popen(command.c_str(), "r");
    for (char part[512]; pipe && std::fgets(part, sizeof part, pipe);) said += part;
    if (pipe) pclose(pipe);
    const std::regex found(R"(hash of this build: (\w+)[^]*bits of the C library: (\w+))");
    std::smatch match;
    return std::regex_search(said, match, found) ? std::pair<std::string, std::string>(match[1], match[2])
                                                 : std::pair<std::string, std::string>();
  };
  const auto [hash, libm] = numbers("glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4");
  char golden[32];
  std::snprintf(golden, sizeof golden, "0x%016" PRIx64, kGolden);
  EXPECT_EQ(hash, golden);
  if (libm == numbers("").second) GTEST_SKIP() << "this C library has one version of its mathematics only";
}

}  // namespace
}  // namespace liana
