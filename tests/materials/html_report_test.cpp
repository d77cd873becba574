#include "materials/report/html_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "materials/report/model_comparison.h"
#include "mesher/base/base64.h"
#include "tests/support/solids/shapes.h"

namespace liana {
namespace {

SpeciesLaw test_law() {
  SpeciesLaw law;
  law.species = "test";
  law.groups = {{"level0", {}}, {"level1", {}}, {"leaf", {}}};
  return law;
}

struct Baked {
  SegmentedPlant plant = make_small_plant();
  BakeResult result;
};

Baked baked(SegmentedPlant plant = make_small_plant()) {
  Progress silent;
  Baked both{std::move(plant), {}};
  both.result = bake_plant(both.plant, test_law(), {}, silent);
  return both;
}

nlohmann::json data_of(const std::string& page) {
  const std::string open = "<script id=\"data\" type=\"application/json\">";
  const size_t from = page.find(open) + open.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

TEST(Base64, IsThatOfTheStandard) {  // RFC 4648 §10
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\x00"), "//4=");  // the literal ends at its zero
}

TEST(HtmlReport, HoldsEveryDomainAndTriangle) {
  const Baked both = baked();
  const nlohmann::json data = data_of(html_report(both.plant, both.result));
  const Bake& bake = both.result.bake;
  ASSERT_EQ(data["domains"]["name"].size(), bake.domains.size());
  for (size_t id = 0; id < bake.domains.size(); ++id) {
    EXPECT_EQ(data["domains"]["name"][id], bake.domains[id].name);
    EXPECT_NEAR(data["domains"]["nu"][id].get<double>() / bake.domains[id].material.frequency, 1, 1e-4);
    EXPECT_EQ(data["models"].size(), 4u);
  }
  size_t triangles = 0, vertices = 0, expected = 0, bytes = 0;
  for (const auto& piece : data["mesh"]["pieces"]) {
    triangles += data["mesh"]["shapes"][piece[2].get<size_t>()][1].get<size_t>();
    vertices += piece[1].get<size_t>();
  }
  for (const Domain& domain : both.plant.domains)
    expected += domain.surface.triangles.size(), bytes += 6 * domain.surface.positions.size();
  EXPECT_EQ(triangles, expected);
  EXPECT_EQ(vertices * 6, bytes);
  EXPECT_EQ(data["mesh"]["positions"].get<std::string>().size(), (bytes + 2) / 3 * 4);
}

TEST(HtmlReport, LeavesShareTheirTriangles) {
  const Baked both = baked();
  const nlohmann::json mesh = data_of(html_report(both.plant, both.result))["mesh"];
  std::set<size_t> shapes;
  for (size_t i = 0; i < both.plant.domains.size(); ++i)
    if (both.plant.domains[i].kind == DomainKind::Leaf) shapes.insert(mesh["pieces"][i][2].get<size_t>());
  EXPECT_EQ(shapes.size(), 1u);
}

TEST(HtmlReport, NeedsNoNetworkAndLeavesNothingUnfilled) {
  const Baked both = baked();
  const std::string page = html_report(both.plant, both.result);
  for (const char* foreign : {"http://", "https://", "<link", "src=", "import ", "{{"})
    EXPECT_EQ(page.find(foreign), std::string::npos) << foreign;
}

TEST(HtmlReport, NamesCannotEndTheScript) {
  SegmentedPlant plant = make_small_plant();
  plant.domains[1].name = "</script><b>\"\\\x80";
  const Baked both = baked(plant);
  const std::string page = html_report(both.plant, both.result);
  EXPECT_EQ(page.find("</script><b>"), std::string::npos);
  EXPECT_EQ(data_of(page)["domains"]["name"][1], "</script><b>\"\\\xEF\xBF\xBD");
}

TEST(HtmlReport, ShowsWhatWasLeftOut) {
  SegmentedPlant plant = make_small_plant();
  plant.domains.back().surface = {{Vec3(0, 1, 0), Vec3(0, 1, 0), Vec3(0, 1, 0)}, {{0, 1, 2}}};
  const Baked both = baked(plant);
  const nlohmann::json data = data_of(html_report(both.plant, both.result));
  ASSERT_EQ(data["failed"].size(), 1u);
  EXPECT_EQ(data["mesh"]["pieces"].back()[0], -1);
  EXPECT_EQ(data["mesh"]["pieces"][0][0], 0);
}

TEST(HtmlReport, DoubtsParentsThatAreMoreLikelyWrong) {
  Baked both = baked();
  both.plant.domains[2].parent_confidence = 0.3;
  both.result.bake.domains[3].route = "beam";
  const nlohmann::json doubts = data_of(html_report(both.plant, both.result))["domains"]["doubt"];
  for (size_t id = 0; id < doubts.size(); ++id) EXPECT_EQ(doubts[id] == "", id != 2 && id != 3) << id;
}

TEST(CompareModels, EachIsWhatABakeByThatModelGives) {
  const Baked both = baked();
  const ModelComparison comparison = compare_models(both.result.bake);
  for (size_t i = 0; i < std::size(kMaterialModels); ++i) {
    SpeciesLaw law = test_law();
    law.model.model = kMaterialModels[i];
    Progress silent;
    const Bake bake = bake_plant(both.plant, law, {}, silent).bake;
    for (size_t id = 0; id < bake.domains.size(); ++id)
      EXPECT_EQ(comparison.models[i].frequencies[id], bake.domains[id].material.frequency);
  }
  const std::string csv = comparison_csv(both.result.bake, comparison);
  EXPECT_EQ(static_cast<size_t>(std::count(csv.begin(), csv.end(), '\n')),
            both.result.bake.domains.size() + 1);
}

}  // namespace
}  // namespace liana
