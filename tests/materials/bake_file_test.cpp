#include "materials/bake/bake_file.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <random>

#include "materials/bake/bake_check.h"
#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "mesher/base/hash.h"
#include "tests/support/scratch_folder.h"

namespace liana {
namespace {

namespace fs = std::filesystem;

BakedDomain domain(const std::string& name, DomainId parent, DomainKind kind, double length) {
  BakedDomain domain;
  domain.name = name;
  domain.parent = parent;
  domain.kind = kind;
  domain.level = parent.valid() ? 1 : 0;
  domain.group = kind == DomainKind::Leaf ? "leaf" : "level0";
  domain.length = length;
  domain.mass = 0.1 / 3;
  domain.tets = 120;
  domain.dof = 900;
  domain.default_frequency = 7.0 / 3;
  domain.material = {1.0 / 3, 2.0 / 3, 0.05, 0, 0.01 / 3};
  domain.stiffness_scaling = 0.1;
  domain.youngs_modulus = 1e9 / 3;
  domain.density = 700;
  domain.route = "weld+cap";
  domain.solved_as = DomainId(size_t{0});
  domain.centreline = {{Vec3(0, 0, 0), 0.02, 0.01}, {Vec3(0, 1.0 / 3, 0), 0.01, 0.005}};
  domain.flat_normal = Vec3(1, 2, 2) / 3;
  domain.stiffness_ratio = 1.25;
  return domain;
}

Bake sample() {
  Bake bake;
  bake.plant = "träd.glb";
  bake.plant_hash = 0x0123456789abcdef;
  bake.species_hash = 0xfedcba9876543210;
  bake.law.species = "test";
  bake.law.default_material = {8.77e9, 745, 0.3};
  bake.law.groups["level0"].reference_frequency = 4.0 / 3;
  bake.law.groups["leaf"].damping.kappa = 5;
  bake.law.groups["leaf"].damping.delta = 0.25;
  bake.domains.push_back(domain("trunk", {}, DomainKind::Branch, 2));
  bake.domains.push_back(domain("leaf", DomainId(size_t{0}), DomainKind::Leaf, 0.1));
  bake.failed = {"twig: open", ""};
  return bake;
}

/// The error that the bytes are refused with.
std::string refusal(std::string_view bytes) {
  try {
    decode_bake(bytes, "some.bake");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, Error::Kind::Input);
    EXPECT_NE(std::string(error.what()).find("some.bake"), std::string::npos);
    EXPECT_FALSE(error.hint.empty());
    return error.what();
  }
  ADD_FAILURE() << "accepted";
  return {};
}

void set_bytes(std::string& bytes, size_t at, auto value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

/// With size and checksum corrected, so that only the payload's own checks stand between it and the program.
std::string with_payload(std::string payload) {
  std::string bytes = encode_bake(sample()).substr(0, 32);
  set_bytes(bytes, 16, static_cast<uint64_t>(payload.size()));
  set_bytes(bytes, 24, hash_bytes(payload.data(), payload.size()));
  return bytes + payload;
}

TEST(BakeFile, GivesBackEveryBit) {
  const Bake bake = sample(), read = decode_bake(encode_bake(bake), "bake");
  EXPECT_EQ(encode_bake(read), encode_bake(bake));
  EXPECT_EQ(read.plant, bake.plant);
  EXPECT_EQ(read.plant_hash, bake.plant_hash);
  EXPECT_EQ(read.species_hash, bake.species_hash);
  EXPECT_EQ(read.failed, bake.failed);
  ASSERT_EQ(read.domains.size(), 2u);
  EXPECT_EQ(read.domains[1].parent, DomainId(size_t{0}));
  EXPECT_EQ(read.domains[1].kind, DomainKind::Leaf);
  EXPECT_FALSE(read.domains[0].parent.valid());
  EXPECT_EQ(std::bit_cast<uint64_t>(read.domains[0].material.frequency), std::bit_cast<uint64_t>(1.0 / 3));
  EXPECT_EQ(read.domains[0].centreline[1].position, bake.domains[0].centreline[1].position);
  EXPECT_EQ(read.domains[0].flat_normal, bake.domains[0].flat_normal);
}

// The runtime evaluates it for branches that do not exist yet.
TEST(BakeFile, CarriesTheWholeLaw) {
  const Bake bake = sample(), read = decode_bake(encode_bake(bake), "bake");
  for (const char* group : {"level0", "level3", "leaf"}) {
    const DomainMaterial before = evaluate(bake.law.group(group), 0.7),
                         after = evaluate(read.law.group(group), 0.7);
    EXPECT_EQ(std::memcmp(&before, &after, sizeof before), 0) << group;
  }
}

TEST(BakeFile, IsWrittenWholeAndRead) {
  const ScratchFolder folder;
  const fs::path path = folder / "tree.bake";
  write_bake(sample(), path);
  EXPECT_EQ(encode_bake(read_bake(path)), encode_bake(sample()));
}

TEST(BakeFile, MissingFileAndFolderAreNamed) {
  EXPECT_THROW(read_bake("nowhere.bake"), Error);
  EXPECT_THROW(read_bake("/"), Error);
  EXPECT_THROW(write_bake(sample(), "/nowhere/at/all.bake"), Error);
}

TEST(BakeFile, IsRefusedWhenCutAtAnyByte) {
  const std::string bytes = encode_bake(sample());
  for (size_t size = 0; size < bytes.size(); ++size) refusal(std::string_view(bytes).substr(0, size));
  refusal(bytes + "x");
}

TEST(BakeFile, IsRefusedWithAnyByteFlipped) {
  const std::string bytes = encode_bake(sample());
  for (size_t at = 0; at < bytes.size(); ++at)
    for (int bit : {0, 3, 7}) {
      std::string flipped = bytes;
      flipped[at] = static_cast<char>(flipped[at] ^ (1 << bit));
      refusal(flipped);
    }
}

TEST(BakeFile, OtherVersionIsNamed) {
  std::string bytes = encode_bake(sample());
  set_bytes(bytes, 8, kBakeVersion + 1);
  EXPECT_NE(refusal(bytes).find("version " + std::to_string(kBakeVersion + 1)), std::string::npos);
}

TEST(BakeFile, RandomBytesAreNoBake) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    std::string bytes(trial * 7, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    refusal(bytes);
  }
}

// A payload that lies with a right checksum either is refused or decodes to a bake that keeps the rules; it
// never reads past its end nor allocates what it cannot hold. (The address sanitizer build sees to the
// former.)
TEST(BakeFile, LyingPayloadsAreRefusedOrKeepTheRules) {
  const std::string payload = encode_bake(sample()).substr(32);
  std::mt19937 random(2);
  int refused = 0;
  const auto tolerate = [&](const std::string& bytes) {
    try {
      check(decode_bake(with_payload(bytes), "bake"), "bake");
    } catch (const Error&) {
      ++refused;
    }
  };
  for (int trial = 0; trial < 5000; ++trial) {
    std::string changed = payload;
    for (int change = 0; change <= trial % 3; ++change)
      changed[random() % changed.size()] = static_cast<char>(random() % 3 == 0 ? 0xff : random());
    tolerate(changed);
  }
  for (size_t at = 0; at + 4 <= payload.size(); ++at) {
    std::string changed = payload;
    set_bytes(changed, at, uint32_t{0xfffffff0});  // an absurd count, wherever one stands
    tolerate(changed);
  }
  EXPECT_GT(refused, 500);
}

TEST(BakeFile, RulesAreCheckedOnWritingToo) {
  const ScratchFolder folder;
  const auto refused = [&](auto change) {
    Bake bake = sample();
    change(bake);
    EXPECT_THROW(write_bake(bake, folder / "never.bake"), Error);
    EXPECT_FALSE(fs::exists(folder / "never.bake"));
    refusal(encode_bake(bake));
  };
  refused([](Bake& bake) { bake.domains[0].parent = DomainId(size_t{1}); });
  refused([](Bake& bake) { bake.domains[1].parent = DomainId(size_t{1}); });
  refused([](Bake& bake) { bake.domains[0].length = std::nan(""); });
  refused([](Bake& bake) { bake.domains[0].mass = -1; });
  refused([](Bake& bake) { bake.domains[0].material.damping_factor = -0.1; });
  refused([](Bake& bake) { bake.domains[0].material.frequency = 0; });
  refused([](Bake& bake) { bake.domains[0].centreline.pop_back(); });
  refused([](Bake& bake) { bake.domains[0].centreline[1].position.x() = INFINITY; });
  refused([](Bake& bake) { bake.domains[0].solved_as = DomainId(size_t{2}); });
  refused([](Bake& bake) { bake.domains[0].kind = static_cast<DomainKind>(7); });
  refused([](Bake& bake) { bake.domains[0].flat_normal = Vec3::Zero(); });
  refused([](Bake& bake) { bake.law.default_material.density = -700; });
  refused([](Bake& bake) { bake.law.groups["leaf"].damping.delta = 6; });
  refused([](Bake& bake) { bake.law.groups.clear(); });
}

}  // namespace
}  // namespace liana
