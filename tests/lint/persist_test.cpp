// No data member of a class with state can be forgotten: it is in the class's persist(), or in a comment
// there that says why it is no state.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/lint/class_members.h"

namespace liana::lint {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> forgotten(const ClassText& text) {
  std::vector<std::string> missing;
  const Persisted persisted = persisted_names(*text.persist);
  for (const std::string& member : text.members)
    if (std::find(persisted.names.begin(), persisted.names.end(), member) == persisted.names.end())
      missing.push_back(member);
  return missing;
}

TEST(Persist, NoMemberIsForgotten) {
  size_t classes = 0, members = 0;
  for (const char* folder : {"mesher", "materials", "runtime"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(LIANA_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".h") continue;
      std::ifstream in(entry.path());
      std::stringstream text;
      text << in.rdbuf();
      for (const ClassText& one : classes_of(text.str())) {
        if (!one.persist) continue;
        ++classes, members += one.members.size();
        for (const std::string& name : forgotten(one))
          ADD_FAILURE() << entry.path() << ": " << one.name << "::" << name
                        << " is neither in persist() nor in a comment `// not state: " << name << ": why`";
        EXPECT_TRUE(persisted_names(*one.persist).all_reasoned)
            << entry.path() << ": " << one.name << ": a `not state:` without a reason";
      }
    }
  EXPECT_GT(classes, 50u) << "they are found";
  EXPECT_GT(members, 300u);
}

TEST(Persist, MembersOfAllKindsAreSeenAndForgottenOnesNamed) {
  const std::vector<ClassText> classes = classes_of(R"(
namespace a::b {
/// A comment with { and ; and "quotes".
class alignas(64) Outer final : public Base<int> {
 public:
  explicit Outer(int x = 3, const Options& options = {}) : x_(x) {}
  Outer& operator=(const Outer&) = delete;
  int size() const { return x_; }
  Nested operator()(int) const;
  template <class Archive>
  void persist(Archive& a) {
    a(x_, second_);  // third_ is not here
    // not state: map_: a reason that is given; raw_: another one,
    // in two lines
  }
 private:
  struct Nested { double width = 1, height; };
  enum class Kind { A, B } ;
  static constexpr int kSize = 4;
  using Key = std::array<int, 3>;
  friend class Other;
  int x_, second_{2}, third_ = f(1, 2);
  std::map<Key, std::vector<Nested>> map_;  // a comment; with more
  const Nested* raw_[3] = {nullptr, nullptr};
  std::function<void(unsigned)> called_;
  Nested& reference_;
  Mat3 back_ = Mat3::Identity(), forth_ = back_;
};
}
)");
  ASSERT_EQ(classes.size(), 2u);
  EXPECT_EQ(classes[0].name, "Outer::Nested");
  EXPECT_EQ(classes[0].members, (std::vector<std::string>{"width", "height"}));
  EXPECT_EQ(classes[1].name, "Outer");
  EXPECT_EQ(classes[1].members, (std::vector<std::string>{"x_", "second_", "third_", "map_", "raw_",
                                                          "called_", "reference_", "back_", "forth_"}));
  EXPECT_EQ(forgotten(classes[1]),
            (std::vector<std::string>{"third_", "called_", "reference_", "back_", "forth_"}));
  EXPECT_FALSE(persisted_names("a(b);\n// not state: c").all_reasoned);
}

}  // namespace
}  // namespace liana::lint
