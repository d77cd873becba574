#include "materials/report/bake_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

namespace liana {
namespace {

BakeResult sample() {
  BakeResult result;
  result.bake.plant = "tree";
  result.bake.law.species = "apple";
  result.bake.domains.resize(2);
  result.bake.domains[0].name = "trunk \xff";  // no UTF-8
  result.bake.domains[0].solved_as = DomainId(size_t{0});
  result.bake.domains[1].parent = DomainId(size_t{0});
  result.bake.domains[1].kind = DomainKind::Leaf;
  result.bake.domains[1].solved_as = DomainId(size_t{0});
  result.bake.domains[1].length = 0.25;
  result.bake.failed = {"twig: open"};
  result.seconds.modal = 1.5;
  return result;
}

std::set<std::string> keys(const nlohmann::json& object) {
  std::set<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.insert(key);
  return keys;
}

TEST(BakeReport, HasTheStableKeys) {
  const auto report = nlohmann::json::parse(bake_report(sample()));
  for (const char* key : {"plant", "species", "seconds", "domains"}) EXPECT_TRUE(report.contains(key)) << key;
  EXPECT_EQ(keys(report["seconds"]),
            (std::set<std::string>{"read", "cache", "surface", "tets", "modal", "laws", "write", "total"}));
  EXPECT_EQ(keys(report["domains"][0]),
            (std::set<std::string>{
                "id",        "name",    "parent", "kind",          "level", "group",   "length_m",
                "mass_kg",   "tets",    "dof",    "nu_default_hz", "nu_hz", "alpha_k", "alpha_m",
                "youngs_pa", "density", "xi",     "d_m",           "d_k",   "route",   "solved_as"}));
}

TEST(BakeReport, TellsWhatTheBakeTells) {
  const auto report = nlohmann::json::parse(bake_report(sample()));
  EXPECT_EQ(report["plant"], "tree");
  EXPECT_EQ(report["seconds"]["modal"], 1.5);
  EXPECT_TRUE(report["domains"][0]["parent"].is_null());
  EXPECT_EQ(report["domains"][1]["parent"], 0);
  EXPECT_EQ(report["domains"][1]["kind"], "leaf");
  EXPECT_EQ(report["domains"][1]["solved_as"], 0);
  EXPECT_EQ(report["domains"][1]["length_m"], 0.25);
  EXPECT_EQ(report["failed"][0], "twig: open");
}

}  // namespace
}  // namespace liana
