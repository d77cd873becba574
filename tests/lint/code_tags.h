// Functions and types of the sources, as universal-ctags finds them.
#pragma once

#include <string>
#include <vector>

namespace liana::lint {

struct Tag {
  std::string kind;         // function, class, struct, enum, union
  std::string file;         // relative to the top
  int first = 0, last = 0;  // lines of the definition
  std::string scope, name;  // an anonymous namespace is "__anon..." in the scope

  int lines() const { return last - first + 1; }
  bool is_type() const { return kind != "function"; }
  std::string qualified() const { return scope.empty() ? name : scope + "::" + name; }
};

/// All definitions with a body in mesher/, modal/, materials/, runtime/ and tests/.
const std::vector<Tag>& code_tags();

}  // namespace liana::lint
