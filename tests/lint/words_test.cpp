// The field's words instead of our own: a reader who knows other engines shall know these names.
#include <gtest/gtest.h>

#include <cctype>

#include "tests/lint/source_files.h"

namespace liana::lint {
namespace {

struct Word {
  std::vector<std::string> ours;
  const char* fields;
  bool in_comments = true;  // false: there it is plain English
};

const std::vector<Word> kWords = {
    {{"inhabitant", "inhabitants"}, "plant instance"},
    {{"feel"}, "contact material", false},
    {{"elasticity"}, "restitution"},
    {{"grip", "grips"}, "stick anchor"},
    {{"near kin"}, "collision filter"},
    {{"fallen part", "fallen parts"}, "detached part"},
    {{"reseat", "reseats", "reseated", "reseating"}, "joint projection"},
    {{"pluck", "plucks", "plucked", "plucking"}, "impulse"},
    {{"handover", "handovers"}, "extend-add"},
};

constexpr const char* kThisFile = "tests/lint/words_test.cpp";

/// Names and comments, not what stands in quotes: old keys of scene files stay readable.
std::string without_texts(const std::string& line) {
  std::string left;
  bool inside = false;
  for (size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && (i == 0 || (line[i - 1] != '\\' && line[i - 1] != '\''))) inside = !inside;
    if (!inside) left += line[i];
  }
  return left;
}

/// "stepInhabitant_of(feel)" -> " step inhabitant of feel "
std::string words_of(const std::string& line) {
  std::string words = " ";
  bool was_lower = false;
  for (const char c : line) {
    const auto letter = static_cast<unsigned char>(c);
    const bool starts = std::isupper(letter) && was_lower;
    if ((starts || !std::isalpha(letter)) && words.back() != ' ') words += ' ';
    if (std::isalpha(letter)) words += static_cast<char>(std::tolower(letter));
    was_lower = std::islower(letter);
  }
  return words + ' ';
}

TEST(Words, AreSplitAsNamesAre) {
  EXPECT_EQ(words_of("stepInhabitant_of(feel)"), " step inhabitant of feel  ");
  EXPECT_EQ(without_texts("read(\"[[pluck]]\", a)"), "read(\", a)");
}

TEST(Words, AreTheFields) {
  for (const std::string& file : source_files()) {
    if (file == kThisFile) continue;
    int number = 0;
    for (const std::string& line : lines_of(file)) {
      ++number;
      const std::string words = words_of(without_texts(line));
      const std::string code = words_of(without_texts(line.substr(0, line.find("//"))));
      for (const Word& word : kWords)
        for (const std::string& ours : word.ours)
          if ((word.in_comments ? words : code).find(" " + ours + " ") != std::string::npos)
            ADD_FAILURE() << file << ":" << number << " say " << word.fields << ": " << line;
    }
  }
}

}  // namespace
}  // namespace liana::lint
