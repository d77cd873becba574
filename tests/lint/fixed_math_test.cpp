// What the state of a simulation depends on calls no function whose last bits are the C library's: libm's
// transcendental ones, and Eigen's that call them. mesher/base/fixed_math.h and runtime/sim/model/rotation.h
// have ours.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace {
namespace fs = std::filesystem;

const fs::path kTop = LIANA_SOURCE_DIR;

// sim/check measures a simulation and is not part of it.
const std::vector<std::string> kFolders = {
    "mesher/base",      "materials/law",         "modal/material",      "runtime/sim/model",
    "runtime/sim/step", "runtime/sim/calibrate", "runtime/sim/contact", "runtime/obstacles",
    "runtime/growth",   "runtime/wind",          "runtime/world"};

const std::regex& forbidden() {
  // sqrt, fmod, remainder, floor, round and their like are exact by IEEE 754.
  static const std::regex pattern(
      R"((^|[^\w:])(std::)?(sin|cos|tan|sincos|asin|acos|atan|atan2|sinh|cosh|tanh|asinh|acosh|atanh|exp|exp2|expm1|)"
      R"(log|log2|log10|log1p|pow|cbrt|hypot|erf|erfc|tgamma|lgamma|polar)[fl]?\s*\()"
      R"(|AngleAxis|\bslerp\b|angularDistance|eulerAngles|computeDirect|\.(sin|cos|tan|exp|log|pow|tanh)\(\))");
  return pattern;
}

std::vector<std::string> offences(const std::string& text, const std::string& name) {
  std::vector<std::string> found;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string code = line.substr(0, line.find("//"));
    if (std::regex_search(code, forbidden()))
      found.push_back(name + ":" + std::to_string(number) + ": " + line);
  }
  return found;
}

TEST(FixedMath, TheStateDependsOnNoMathematicsLibrary) {
  size_t files = 0;
  for (const std::string& folder : kFolders)
    for (const auto& entry : fs::recursive_directory_iterator(kTop / folder)) {
      const fs::path& path = entry.path();
      if (path.extension() != ".h" && path.extension() != ".cpp") continue;
      if (path.filename().string().rfind("fixed_", 0) == 0) continue;  // defines them
      ++files;
      std::ifstream in(path);
      const std::string text((std::istreambuf_iterator<char>(in)), {});
      for (const std::string& offence : offences(text, fs::relative(path, kTop).string()))
        ADD_FAILURE() << offence;
    }
  EXPECT_GT(files, 100u);
}

TEST(FixedMath, TheLintSeesWhatItIsFor) {
  for (const char* line :
       {"x = std::sin(y);", "return pow(a, b);", "Eigen::AngleAxisd(a, v);", "q.slerp(t, r)",
        "a.array().exp()", "std::hypot (a, b)", "std::polar(1.0, x)", "expf(x)"})
    EXPECT_EQ(offences(line, "").size(), 1u) << line;
  for (const char* line : {"fixed::sin(x);", "// std::sin(x)", "rotation_exp(v)", "cosine(x)", "std::sqrt(x)",
                           "double log_of(double x)", "rotation_log(q)"})
    EXPECT_EQ(offences(line, "").size(), 0u) << line;
}

}  // namespace
