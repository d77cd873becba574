// The page of bake --html in a browser, and its scripts without one.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "mesher/base/files.h"
#include "tests/support/program.h"
#include "tests/support/scratch_folder.h"

namespace liana {
namespace {

namespace fs = std::filesystem;

/// data/plants/apple_small.glb as a page, once for all tests here.
const std::string& page() {
  static const std::string text = [] {
    const ScratchFolder folder;
    const ProgramResult result = run_liana({"bake", LIANA_SOURCE_DIR "/data/plants/apple_small.glb",
                                            "--species", "apple", "-o", "a.bake", "--html", "a.html"},
                                           folder.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_file(folder / "a.html");
  }();
  return text;
}

nlohmann::json data_of_page() {
  const std::string open = "<script id=\"data\" type=\"application/json\">";
  const size_t from = page().find(open) + open.size();
  return nlohmann::json::parse(page().substr(from, page().find("</script>", from) - from));
}

size_t triangles(const nlohmann::json& data) {
  size_t sum = 0;
  for (const auto& piece : data["mesh"]["pieces"])
    sum += data["mesh"]["shapes"][piece[2].get<size_t>()][1].get<size_t>();
  return sum;
}

/// What the page wrote about itself after it was drawn (selfCheck in main.js).
nlohmann::json self_check(const std::string& dom) {
  const size_t tag = dom.find("id=\"self-check\""), from = dom.find('>', tag) + 1;
  EXPECT_NE(tag, std::string::npos);
  std::string text = dom.substr(from, dom.find("</output>", from) - from);
  for (size_t at = 0; (at = text.find("&quot;", at)) != std::string::npos;) text.replace(at, 6, "\"");
  const nlohmann::json found = nlohmann::json::parse(text, nullptr, false);
  EXPECT_TRUE(found.is_object()) << text;
  return found;
}

// A software renderer draws it (SwiftShader), so no GPU is needed. Chromium is 150 MB to fetch and hence not
// among the packages: where it is absent, the test says so.
TEST(ReportPage, DrawsThePlantAndChoosesBothWaysInABrowser) {
  const fs::path chromium = find_program("chromium");
  if (chromium.empty()) GTEST_SKIP() << "chromium is not installed: apt-get install chromium";
  const ScratchFolder folder;
  write_file(folder / "a.html", page());
  const ProgramResult result =
      run_program(chromium,
                  {"--headless", "--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader",
                   "--virtual-time-budget=15000", "--window-size=1280,900",
                   "--user-data-dir=" + (folder / "profile").string(), "--dump-dom",
                   "file://" + (folder / "a.html").string()},
                  folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json found = self_check(result.out), data = data_of_page();
  ASSERT_TRUE(found.is_object());
  EXPECT_TRUE(found["errors"].empty()) << found["errors"];
  EXPECT_EQ(found["domains"], data["domains"]["name"].size());
  EXPECT_EQ(found["rows"], data["domains"]["name"].size());
  EXPECT_EQ(found["csv_lines"], data["domains"]["name"].size());
  EXPECT_EQ(found["triangles"], triangles(data));
  EXPECT_GT(found["drawn_pixels"], 500);  // the plant fills a few per cent of some 400,000
  EXPECT_GE(found["picked"], 0);
  EXPECT_EQ(found["picked_row"], found["picked"]);
  EXPECT_EQ(found["row_to_view"], true);
}

// The scripts run in node with a document that does nothing (report_page_stub.js): no picture, but all of the
// counting, sorting, searching and unpacking.
TEST(ReportPage, ScriptsCountSortAndSearchRightly) {
  const fs::path node = find_program("node");
  if (node.empty()) GTEST_SKIP() << "node is not installed: apt-get install nodejs";
  const ScratchFolder folder;
  write_file(folder / "a.html", page());
  const ProgramResult result =
      run_program(node, {LIANA_SOURCE_DIR "/tests/app/report_page_stub.js", (folder / "a.html").string()});
  ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  const nlohmann::json found = nlohmann::json::parse(result.out), data = data_of_page();
  const size_t count = data["domains"]["name"].size();
  EXPECT_EQ(found["domains"], count);
  EXPECT_EQ(found["histogram_sum"], count);
  EXPECT_EQ(found["class_histogram_sum"], count);
  EXPECT_LT(found["law_error"], 1e-3);  // points lie on their law but for their five digits
  EXPECT_LT(found["damping_error"], 1e-3);
  EXPECT_EQ(found["triangles"], triangles(data));
  EXPECT_EQ(found["indices_in_range"], true);
  EXPECT_EQ(found["found_trunk"], "trunk");
  EXPECT_EQ(found["found_nothing"], 0);
  EXPECT_EQ(found["sorted_by_length"], true);
  EXPECT_EQ(found["doubtful_first"], true);
  EXPECT_EQ(found["ticks"], (std::vector<double>{0.1, 0.2, 0.5, 1, 2, 5}));
  EXPECT_EQ(found["numbers"], (std::vector<std::string>{"8.77 G", "0.0488", "1.76 M", "0", "–"}));
}

}  // namespace
}  // namespace liana
