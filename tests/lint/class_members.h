// Reads C++ headers just well enough to list the data members of classes.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace liana::lint {

struct ClassText {
  std::string name;                    ///< with those it is nested in: A::B
  std::vector<std::string> members;    ///< data members, in order, without static ones
  std::optional<std::string> persist;  ///< the body of its member template persist(), with comments
};

/// All classes and structs of a header, nested ones too.
std::vector<ClassText> classes_of(const std::string& header);

/// Names in a body of persist(): those that its code mentions, and those behind `not state:` in its comments.
struct Persisted {
  std::vector<std::string> names;
  bool all_reasoned = true;  ///< every `not state:` says why, behind a second colon
};
Persisted persisted_names(const std::string& body);

}  // namespace liana::lint
