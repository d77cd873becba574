#include "materials/law/law_override.h"

#include <gtest/gtest.h>

#include "mesher/base/error.h"

namespace liana {
namespace {

SpeciesLaw law() {
  SpeciesLaw law;
  law.species = "test";
  law.groups["level0"] = {};
  law.groups["leaf"] = {};
  return law;
}

TEST(SetNumber, ChangesOneNumberOfOneGroup) {
  SpeciesLaw changed = law();
  set_number(changed, "level0.reference_frequency=1.25");
  set_number(changed, "groups.leaf.damping.low_factor=0.2");
  set_number(changed, "default_material.density=800");
  EXPECT_EQ(changed.groups["level0"].reference_frequency, 1.25);
  EXPECT_EQ(changed.groups["leaf"].reference_frequency, GroupLaw{}.reference_frequency);
  EXPECT_EQ(changed.groups["leaf"].damping.low_factor, 0.2);
  EXPECT_EQ(changed.default_material.density, 800);
}

TEST(SetNumber, SuggestsTheNearestKey) {
  SpeciesLaw changed = law();
  try {
    set_number(changed, "leaf.epsilon=1");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind, Error::Kind::Usage);
    EXPECT_NE(error.hint.find("leaf.epsilon"), std::string::npos);
  }
}

TEST(SetNumber, RefusesWhatIsNoNumberOrNotPossible) {
  for (const char* text : {"leaf.c2", "leaf.c2=", "leaf.c2=x", "leaf.c2=1x", "leaf.c2=-1", "leaf.c2=nan",
                           "leaf.damping.kappa=1", "leaf.damping.delta=9", "=", ""}) {
    SpeciesLaw changed = law();
    EXPECT_THROW(set_number(changed, text), Error) << text;
  }
}

}  // namespace
}  // namespace liana
