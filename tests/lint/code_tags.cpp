#include "tests/lint/code_tags.h"

#include <sstream>

#include "tests/lint/source_files.h"

namespace liana::lint {

const std::vector<Tag>& code_tags() {
  static const std::vector<Tag> all = [] {
    std::istringstream in(
        output_of("ctags --languages=C++ --map-C++=+.h -R --kinds-C++=fcsgu --fields=+neKSsZ -x "
                  "--_xformat='%K|%n|%e|%F|%s|%N' mesher modal materials runtime tests"));
    std::vector<Tag> tags;
    for (std::string line; std::getline(in, line);) {
      std::istringstream fields(line);
      Tag tag;
      std::string first, last;
      std::getline(fields, tag.kind, '|');
      std::getline(fields, first, '|');
      std::getline(fields, last, '|');
      std::getline(fields, tag.file, '|');
      std::getline(fields, tag.scope, '|');
      std::getline(fields, tag.name);
      if (last.empty() || last == "-") continue;
      tag.first = std::stoi(first);
      tag.last = std::stoi(last);
      tags.push_back(tag);
    }
    return tags;
  }();
  return all;
}

}  // namespace liana::lint
