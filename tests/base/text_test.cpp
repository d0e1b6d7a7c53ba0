#include "core/base/text.h"

#include <gtest/gtest.h>

#include "core/base/file.h"

namespace lightvane {
namespace {

TEST(EditDistance, CountsLettersThatChangeAndNeighboursThatSwap) {
  EXPECT_EQ(editDistance("mirror", "mirror"), 0U);
  EXPECT_EQ(editDistance("mirror", "miror"), 1U);
  EXPECT_EQ(editDistance("mirror", "mirrors"), 1U);
  EXPECT_EQ(editDistance("mirror", "mirrro"), 1U);
  EXPECT_EQ(editDistance("", "glass"), 5U);
}

TEST(Suggestion, IsTheNearestWordIfAnyIsNear) {
  const std::vector<std::string> words = {"vectors", "naive", "path", "direct"};
  EXPECT_EQ(nearestWord("vectros", words), "vectors");
  EXPECT_EQ(suggestion("vectros", words), "did you mean vectors?");
  EXPECT_EQ(suggestion("photons", words), "");
}

TEST(WithoutCommands, LeavesLinesAndLetters) {
  EXPECT_EQ(withoutCommands("a\x1b[2J\tb\x7f\n\u00e9"), "a?[2J?b?\n\u00e9");
}

TEST(ListWords, ReadsAsASentenceDoes) {
  EXPECT_EQ(listWords(std::vector<std::string>{"a"}), "a");
  EXPECT_EQ(listWords(std::vector<std::string>{"a", "b"}), "a or b");
  EXPECT_EQ(listWords(std::vector<std::string>{"a", "b", "c"}), "a, b or c");
}

TEST(Lowered, KeepsWhatIsNoLatinLetter) { EXPECT_EQ(lowered("Glas Ä 7_z"), "glas Ä 7_z"); }

TEST(Trimmed, KeepsWhatIsBetweenBlanks) {
  EXPECT_EQ(trimmed(" \ta b\t c\r"), "a b\t c");
  EXPECT_EQ(trimmed("a"), "a");
  EXPECT_EQ(trimmed(" \t\r "), "");
  EXPECT_EQ(trimmed(""), "");
}

TEST(FileEnding, IsOfTheNameAloneAndInLowerCase) {
  EXPECT_EQ(fileEnding("a/Room.EXR"), ".exr");
  EXPECT_EQ(fileEnding("a.b/room"), "");
  EXPECT_EQ(fileEnding("room.old.toml"), ".toml");
  EXPECT_EQ(fileEnding(".exr"), "") << "a hidden file";
}

}  // namespace
}  // namespace lightvane
