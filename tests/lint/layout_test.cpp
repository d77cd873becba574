// What CMake cannot see of the layout: includes from the top, vendor headers at home, direction of includes.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

namespace {
namespace fs = std::filesystem;

const fs::path kTop = LIANA_SOURCE_DIR;

struct Include {
  std::string file;  // relative to the top
  int line;
  std::string target;
};

const std::vector<Include>& includes() {
  static const std::vector<Include> all = [] {
    std::vector<Include> found;
    const std::regex pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
    for (const char* folder : {"mesher", "modal", "materials", "runtime"}) {
      for (const auto& entry : fs::recursive_directory_iterator(kTop / folder)) {
        const std::string extension = entry.path().extension().string();
        if (extension != ".h" && extension != ".cpp") continue;
        std::ifstream in(entry.path());
        std::string text;
        for (int line = 1; std::getline(in, text); ++line) {
          std::smatch match;
          if (std::regex_search(text, match, pattern))
            found.push_back({fs::relative(entry.path(), kTop).string(), line, match[1]});
        }
      }
    }
    return found;
  }();
  return all;
}

std::string at(const Include& include) {
  return include.file + ":" + std::to_string(include.line) + " includes " + include.target;
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& prefixes) {
  for (const std::string& prefix : prefixes)
    if (text.rfind(prefix, 0) == 0) return true;
  return false;
}

TEST(Layout, SourcesAreFound) {
  EXPECT_GT(includes().size(), 100u);
}

TEST(Layout, IncludesAreNamedFromTheTop) {
  for (const Include& include : includes())
    EXPECT_EQ(include.target.find("../"), std::string::npos) << at(include);
}

TEST(Layout, IncludesPointLeft) {
  const std::vector<std::string> order = {"mesher/", "modal/", "materials/", "runtime/"};
  const auto place = [&](const std::string& path) {
    for (size_t i = 0; i < order.size(); ++i)
      if (path.rfind(order[i], 0) == 0) return static_cast<int>(i);
    return -1;
  };
  for (const Include& include : includes())
    EXPECT_LE(place(include.target), place(include.file)) << at(include);
}

const std::vector<std::string> kNotForTheSimulator = {"mesher/exact/",
                                                      "mesher/solids/",
                                                      "mesher/shells/",
                                                      "mesher/tets/",
                                                      "modal/domains/",
                                                      "modal/elements/",
                                                      "modal/solve/",
                                                      "modal/whole_plant/",
                                                      "materials/cache/",
                                                      "materials/pipeline/",
                                                      "materials/report/",
                                                      "materials/video/",
                                                      "runtime/view/",
                                                      "runtime/app/",
                                                      "CGAL/",
                                                      "tetgen.h",
                                                      "epoxy/",
                                                      "GL/",
                                                      "EGL/",
                                                      "GLFW/",
                                                      "imgui"};

// Everything under runtime/ but the window and the program. CMake's HEADLESS checks what their targets link.
TEST(Layout, TheSimulatorSeesNoMesherAndNoOpenGL) {
  for (const Include& include : includes())
    if (include.file.rfind("runtime/", 0) == 0 &&
        !starts_with_any(include.file, {"runtime/view/", "runtime/app/"})) {
      EXPECT_FALSE(starts_with_any(include.target, kNotForTheSimulator)) << at(include);
    }
}

TEST(Layout, VendorHeadersStayAtHome) {
  const std::map<std::string, std::vector<std::string>> homes = {
      {"tetgen.h", {"mesher/tets/tetgen_driver.cpp"}},
      {"CGAL/", {"mesher/exact/"}},
      {"tiny_gltf.h", {"mesher/io/", "runtime/export/"}},
      {"suitesparse/", {"modal/"}},
      {"Spectra/", {"modal/"}},
      {"toml++/", {"materials/law/", "runtime/world/", "runtime/app/"}},
      {"CLI/", {"runtime/app/"}},
      {"embree3/", {"runtime/obstacles/"}},
      {"epoxy/", {"runtime/view/"}},
      {"GLFW/", {"runtime/view/"}},
      {"imgui", {"runtime/view/"}},
      {"stb/", {"runtime/picture/image.cpp"}},
      {"opencv2/",
       {"materials/video/tracks/feature_tracker.cpp", "materials/video/tracks/overlay_frame.cpp"}},
      {"unsupported/", {"materials/video/"}},
      {"OpenMesh/", {"mesher/geometry/half_edge.cpp", "tests/"}},
      {"xxhash.h", {"mesher/base/hash.cpp"}},
  };
  for (const Include& include : includes())
    for (const auto& [header, allowed] : homes)
      if (include.target.rfind(header, 0) == 0) {
        EXPECT_TRUE(starts_with_any(include.file, allowed)) << at(include);
      }
}

}  // namespace
