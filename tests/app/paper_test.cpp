// `lightvane paper`, as a user runs it.

#include <csignal>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/text.h"
#include "core/image/image_file.h"
#include "tests/app/program.h"

namespace lightvane {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

class Paper : public testing::Test {
 protected:
  /// The table's rows, without its head.
  static std::vector<std::string> rowsOf(const std::string& table) {
    std::vector<std::string> rows;
    for (std::size_t begin = 0; begin < table.size();) {
      const std::size_t end = std::min(table.find('\n', begin), table.size());
      const std::string line = table.substr(begin, end - begin);
      if (line.starts_with("| ") && !line.starts_with("| figure")) rows.push_back(line);
      begin = end + 1;
    }
    return rows;
  }

  Program program_;
};

TEST_F(Paper, TellsItsFiguresBesideThosePrinted) {
  const Outcome outcome =
      program_.run({"paper", "--figure", "4", "--scale", "0.05", "--reference", "8", "-o", "pictures/new"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  const std::vector<std::string> rows = rowsOf(outcome.out);
  ASSERT_EQ(rows.size(), 3u) << outcome.out;
  const std::string number = "[0-9.e+-]+";
  const std::string ours = number + " s \\| " + number + " \\| ";
  const std::string error = " \\| " + number + " ± " + number + " \\|";
  EXPECT_THAT(rows[0], MatchesRegex("\\| 4 \\| 20x20 \\| light vectors \\| 10 min \\| 1 \\| 4200 \\| – \\| " +
                                    number + " s \\| 1 \\| [1-9][0-9]* \\| 0" + error));
  EXPECT_THAT(rows[1],
              MatchesRegex("\\| 4 \\| 20x20 \\| direct, ambient term \\| 2 min \\| 0.2 \\| – \\| – \\| " +
                           ours + "– \\| –" + error));
  EXPECT_THAT(rows[2],
              MatchesRegex("\\| 4 \\| 20x20 \\| naive, 128 samples \\| 180 min \\| 18 \\| – \\| – \\| " +
                           ours + "– \\| –" + error));
  EXPECT_THAT(outcome.out, HasSubstr("from 8 paths a pixel"));
  for (const char* method : {"vectors", "direct", "naive", "path"}) {
    for (const char* ending : {".png", ".exr"}) {
      const auto image =
          readImage(program_.path(std::string("pictures/new/fig4-spheres-") + method + ending));
      ASSERT_TRUE(image) << image.error().message();
      EXPECT_EQ(image->width, 20);
      EXPECT_EQ(image->height, 20);
    }
  }
}

TEST_F(Paper, WithoutAReferenceTellsNoErrors) {
  const Outcome outcome =
      program_.run({"paper", "--figure", "3", "--scale", "0.03", "--reference", "0", "-q"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const std::vector<std::string> rows = rowsOf(outcome.out);
  ASSERT_EQ(rows.size(), 3u) << outcome.out;
  for (const std::string& row : rows) EXPECT_THAT(row, testing::EndsWith("| – |"));
  EXPECT_THAT(rows[1], HasSubstr("| direct, ambient term | – | – |"));
  EXPECT_TRUE(program_.exists("paper/fig3-cornell-naive.png"));
  EXPECT_FALSE(program_.exists("paper/fig3-cornell-path.png"));
}

TEST_F(Paper, StoppedTellsWhatThereIs) {
  program_.start({"paper", "--figure", "3", "--scale", "0.1", "--reference", "10000000"});
  ASSERT_TRUE(program_.waitForError("figure 3, path"));
  program_.signal(SIGINT);
  const Outcome outcome = program_.finish();
  EXPECT_EQ(outcome.exitCode, 130) << outcome.err;
  EXPECT_EQ(rowsOf(outcome.out).size(), 3u) << outcome.out;
}

TEST_F(Paper, RefusesWhatItCannotDo) {
  const auto expectRefused = [&](const std::vector<std::string>& words, const char* message) {
    const Outcome outcome = program_.run(words);
    EXPECT_EQ(outcome.exitCode, 2) << words.back();
    EXPECT_THAT(outcome.err, HasSubstr(message));
    EXPECT_EQ(outcome.out, "");
  };
  expectRefused({"paper", "--figure", "2"}, "--figure: expected 3, 4 or 5, found '2'");
  expectRefused({"paper", "--scale", "0"}, "--scale: expected a factor from 0.01 to 10, found '0'");
  expectRefused({"paper", "--reference", "1"}, "--reference: expected 0, or from 2 paths a pixel");
  expectRefused({"paper", "--scael", "1"}, "there is no option --scael");
  expectRefused({"paper", "room.toml"}, "unexpected word 'room.toml'");
  program_.write("file", "");
  expectRefused({"paper", "-o", "file"}, "file: is no folder, and cannot be made one");
}

}  // namespace
}  // namespace lightvane
