// What is written is read back to the bit; damaged bytes are an error, never a crash.
#include "mesher/base/archive.h"

#include <gtest/gtest.h>

#include "mesher/base/random.h"

namespace liana {
namespace {

enum class Colour : uint8_t { Red, Green };

struct Leaf {
  double area = 0;
  Colour colour = Colour::Red;
  bool fresh = false;
  template <class Archive>
  void persist(Archive& a) {
    a(area, colour, fresh);
  }
  bool operator==(const Leaf&) const = default;
};

struct Everything {
  int number = 0;
  Vec3 place = Vec3::Zero();
  Quat turn = Quat::Identity();
  ParticleId id;
  std::string name;
  std::vector<double> lengths;
  std::vector<Leaf> leaves;
  std::vector<std::string> names;
  std::optional<Leaf> best;
  std::array<float, 3> three{};
  std::map<std::array<int, 2>, std::vector<Leaf>> cells;
  std::unique_ptr<Leaf> own;
  const int* outside = nullptr;
  std::pair<uint64_t, Colour> pair{};
  double raw[2] = {0, 0};
  template <class Archive>
  void persist(Archive& a) {
    a(number, place, turn, id, name, lengths, leaves, names, best, three, cells, own, outside, pair, raw);
  }
};

const int kOutside[2] = {0, 0};

template <class A>
A& knowing(A&& archive) {
  for (const int& object : kOutside) archive.know(&object);
  return archive;
}

Everything example() {
  Everything e;
  e.number = -7, e.place = {1, -0.0, 3e-300}, e.turn = Quat(0.5, 0.5, -0.5, 0.5), e.id = ParticleId(9);
  e.name = "ivy", e.lengths = {1, 2, 3}, e.leaves = {{1, Colour::Green, true}, {2, Colour::Red, false}};
  e.names = {"", "a", "bc"}, e.best = Leaf{3, Colour::Green, false}, e.three = {1, 2, 3};
  e.cells = {{{-1, 2}, {{4, Colour::Red, true}}}, {{5, 0}, {}}};
  e.own = std::make_unique<Leaf>(Leaf{5, Colour::Red, true});
  e.outside = &kOutside[1], e.pair = {1ull << 60, Colour::Green}, e.raw[1] = 8;
  return e;
}

StateBytes written(Everything& e) {
  StateBytes bytes;
  StateWriter writer(bytes);
  knowing(writer)(e);
  return bytes;
}

uint64_t hash_of(Everything& e) {
  StateHasher hasher;
  knowing(hasher)(e);
  return hasher.hash();
}

TEST(Archive, WhatIsWrittenIsReadBackToTheBit) {
  Everything e = example(), read;
  read.lengths = {9, 9, 9, 9}, read.cells[{0, 0}];
  const StateBytes bytes = written(e);
  StateReader reader(bytes.view());
  knowing(reader)(read);
  reader.finish();
  EXPECT_EQ(written(read), bytes);
  EXPECT_EQ(read.leaves, e.leaves);
  EXPECT_EQ(read.cells, e.cells);
  EXPECT_EQ(*read.own, *e.own);
  EXPECT_EQ(read.outside, e.outside);
  EXPECT_TRUE(std::signbit(read.place.y()));
  EXPECT_EQ(hash_of(read), hash_of(e));
}

TEST(Archive, HashSeesEveryByte) {
  Everything e = example();
  const uint64_t before = hash_of(e);
  e.leaves[1].fresh = true;
  EXPECT_NE(hash_of(e), before);
  e = example();
  e.lengths.assign(10000, 1.0);
  const uint64_t many = hash_of(e);
  for (const size_t i : {size_t{0}, size_t{511}, size_t{512}, size_t{9999}}) {
    e.lengths[i] = 2;
    EXPECT_NE(hash_of(e), many) << i;
    e.lengths[i] = 1;
  }
  EXPECT_EQ(hash_of(e), many);
}

TEST(Archive, PointersReadAsObjectsKnownToTheReader) {
  Everything e = example(), read;
  const StateBytes bytes = written(e);
  StateReader stranger(bytes.view());
  EXPECT_THROW(stranger(read), Error) << "an object that it does not know";
  StateBytes out;
  StateWriter writer(out);
  EXPECT_THROW(writer(e), std::logic_error);
}

TEST(Archive, DamagedOrCutBytesAreAnErrorOrAnotherState) {
  Everything e = example();
  const StateBytes bytes = written(e);
  for (size_t size = 0; size < bytes.size(); ++size) {
    Everything read;
    StateReader reader(bytes.view().first(size));
    EXPECT_THROW((knowing(reader)(read), reader.finish()), Error) << size;
  }
  Random random(3, "tests/archive");
  size_t errors = 0;
  for (int i = 0; i < 5000; ++i) {
    StateBytes other = bytes;
    other.data()[random.next() % other.size()] ^= static_cast<std::byte>(1 + random.next() % 255);
    Everything read;
    StateReader reader(other.view());
    try {
      knowing(reader)(read);
      reader.finish();
    } catch (const Error&) {
      ++errors;
    }
  }
  EXPECT_GT(errors, 100u);
}

}  // namespace
}  // namespace liana
