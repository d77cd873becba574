#include "tests/lint/class_members.h"

#include <algorithm>
#include <regex>
#include <sstream>

namespace liana::lint {
namespace {

/// Comments and texts blanked out, so that places stay the same.
std::string without_comments(std::string text) {
  for (size_t i = 0; i + 1 < text.size(); ++i) {
    size_t end = i;
    if (text.compare(i, 2, "//") == 0) {
      end = std::min(text.find('\n', i), text.size());
    } else if (text.compare(i, 2, "/*") == 0) {
      end = std::min(text.find("*/", i) + 2, text.size());
    } else if (text[i] == '"') {
      for (end = i + 1; end < text.size() && text[end] != '"'; ++end) end += text[end] == '\\';
      end = std::min(end + 1, text.size());
    } else if (text[i] == '\'' && i > 0 && !std::isalnum(static_cast<unsigned char>(text[i - 1]))) {
      end = std::min(text.find('\'', i + 1 + (text[i + 1] == '\\')) + 1, text.size());
    }
    for (size_t k = i; k < end; ++k)
      if (text[k] != '\n') text[k] = ' ';
    if (end > i) i = end - 1;
  }
  return text;
}

size_t closing(const std::string& code, size_t open) {
  int depth = 0;
  for (size_t i = open; i < code.size(); ++i) {
    depth += code[i] == '{', depth -= code[i] == '}';
    if (depth == 0) return i;
  }
  return code.size();
}

std::string trimmed_text(const std::string& text) {
  const size_t first = text.find_first_not_of(" \n\t"), last = text.find_last_not_of(" \n\t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

bool starts_with_word(const std::string& text, const std::vector<std::string>& words) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return text.rfind(word, 0) == 0 &&
           (text.size() == word.size() || !std::isalnum(static_cast<unsigned char>(text[word.size()])));
  });
}

/// A parenthesis that is not inside of <...>: a function.
bool has_parameters(const std::string& text) {
  if (std::regex_search(text, std::regex(R"(\boperator\b)"))) return true;
  int depth = 0;
  for (const char c : text) {
    depth += c == '<', depth -= c == '>';
    if (c == '(' && depth <= 0) return true;
    if (c == '=' && depth <= 0) return false;
  }
  return false;
}

/// The names that a declaration of data members declares: `Vec3 a = ..., b{}, c[3]`.
void add_declared(const std::string& declaration, std::vector<std::string>& names) {
  std::string piece;
  int depth = 0;
  bool initial = false;
  const auto finish = [&] {
    const std::regex last_name(R"(([A-Za-z_]\w*)\s*(\[[^\]]*\]\s*)*(:\s*\d+\s*)?$)");
    std::smatch match;
    const std::string text = trimmed_text(piece);
    if (std::regex_search(text, match, last_name)) names.push_back(match[1]);
    piece.clear();
    initial = false;
  };
  for (const char c : declaration) {
    if (c == '(' || c == '{' || (c == '<' && !initial)) ++depth;
    if (!initial && depth == 0 && c == '=') initial = true;
    if (c == '{' && depth == 1) initial = true;
    if (depth == 0 && c == ',') {
      finish();
      continue;
    }
    if (!initial) piece += c;
    if (c == ')' || c == '}' || (c == '>' && !initial)) --depth;
  }
  finish();
}

struct Reader {
  const std::string& whole;  // with comments
  const std::string& code;   // without
  std::vector<ClassText>& found;

  /// A class's body between its braces.
  void read_body(size_t begin, size_t end, const std::string& name) {
    ClassText own{name, {}, {}};
    size_t start = begin;
    int parentheses = 0;
    for (size_t i = begin; i < end; ++i) {
      parentheses += code[i] == '(', parentheses -= code[i] == ')';
      if (parentheses > 0) continue;
      if (code[i] == ';') {
        read_declaration(code.substr(start, i - start), own);
        start = i + 1;
      } else if (code[i] == ':' && code[i + 1] != ':' && code[i - 1] != ':' &&
                 starts_with_word(trimmed_text(code.substr(start, i - start)),
                                  {"public", "private", "protected"}) &&
                 trimmed_text(code.substr(start, i - start)).find_first_of(" (<") == std::string::npos) {
        start = i + 1;
      } else if (code[i] == '{') {
        const size_t close = closing(code, i);
        const std::string head = trimmed_text(code.substr(start, i - start));
        if (std::regex_search(head, std::regex(R"(^(template\s*<[^{]*>\s*)?(struct|class)\b)"))) {
          read_class(head, i, close, name);
        } else if (has_parameters(head)) {
          if (std::regex_search(head, std::regex(R"(\bpersist\s*\()")))
            own.persist = whole.substr(i + 1, close - i - 1);
        } else if (!starts_with_word(head, {"enum", "union", "namespace", "extern"})) {
          i = close;  // a member's initial value
          continue;
        }
        i = start = close + 1;
        --i;
      }
    }
    if (!name.empty()) found.push_back(std::move(own));
  }

  void read_class(const std::string& head, size_t open, size_t close, const std::string& outer) {
    std::smatch match;
    if (!std::regex_search(head, match, std::regex(R"((?:struct|class)\s+(?:alignas\([^)]*\)\s*)?(\w+))")))
      return;
    read_body(open + 1, close, outer.empty() ? match[1].str() : outer + "::" + match[1].str());
  }

  void read_declaration(const std::string& text, ClassText& own) const {
    const std::string declaration = trimmed_text(text);
    if (declaration.empty() || has_parameters(declaration) ||
        starts_with_word(declaration,
                         {"using", "typedef", "friend", "static", "struct", "class", "enum", "template"}))
      return;
    add_declared(declaration, own.members);
  }

  /// Namespaces are looked into, all else outside of classes is passed over.
  void read_file(size_t begin, size_t end) {
    size_t start = begin;
    for (size_t i = begin; i < end; ++i) {
      if (code[i] == ';' || code[i] == '}') start = i + 1;
      if (code[i] != '{') continue;
      const size_t close = closing(code, i);
      const std::string head = trimmed_text(code.substr(start, i - start));
      if (std::regex_search(head, std::regex(R"(\bnamespace\b[^;={}()]*$)")))
        read_file(i + 1, close);
      else if (!has_parameters(std::regex_replace(head, std::regex(R"(alignas\([^)]*\))"), "")))
        read_class(head, i, close, "");
      i = close;
      start = close + 1;
    }
  }
};

}  // namespace

std::vector<ClassText> classes_of(const std::string& header) {
  std::vector<ClassText> found;
  std::string code = without_comments(header);
  for (size_t i = 0; i < code.size(); ++i)  // preprocessor lines
    if (code[i] == '#')
      for (; i < code.size() && code[i] != '\n'; ++i) code[i] = ' ';
  Reader{header, code, found}.read_file(0, code.size());
  return found;
}

Persisted persisted_names(const std::string& body) {
  Persisted result;
  std::string comments, code;
  for (size_t i = 0; i < body.size();) {
    const size_t comment = std::min(body.find("//", i), body.size());
    code += body.substr(i, comment - i);
    const size_t end = std::min(body.find('\n', comment), body.size());
    if (comment < body.size()) comments += body.substr(comment + 2, end - comment - 2) + " ";
    i = end;
  }
  const auto add = [&](const std::string& text) {
    const std::regex word(R"([A-Za-z_]\w*)");
    for (std::sregex_iterator it(text.begin(), text.end(), word), last; it != last; ++it)
      result.names.push_back(it->str());
  };
  add(code);
  const std::string mark = "not state:";
  for (size_t at = comments.find(mark); at != std::string::npos;) {
    const size_t next = comments.find(mark, at + mark.size());
    const std::string note = comments.substr(at + mark.size(), next - at - mark.size());
    std::stringstream groups(note);  // names: why; names: why
    size_t reasons = 0;
    for (std::string group; std::getline(groups, group, ';');) {
      const size_t colon = group.find(':');
      if (colon == std::string::npos) continue;  // more of the reason before it
      reasons += trimmed_text(group.substr(colon + 1)).size() >= 5;
      add(group.substr(0, colon));
    }
    if (reasons == 0) result.all_reasoned = false;
    at = next;
  }
  return result;
}

}  // namespace liana::lint
