#include "runtime/app/terminal_progress.h"

#include <gtest/gtest.h>

#include <csignal>

namespace liana {
namespace {

TEST(ProgressBar, FillsWithWhatIsDone) {
  EXPECT_EQ(progress_bar("modal", 0, 4, 0), "modal    [..............................] 0/4");
  EXPECT_EQ(progress_bar("modal", 2, 4, 0.1), "modal    [###############...............] 2/4");
  EXPECT_EQ(progress_bar("modal", 4, 4, 9), "modal    [##############################] 4/4");
  EXPECT_EQ(progress_bar("modal", 0, 0, 9), "modal    [##############################] 0/0");
}

// 10 of 40 in 2 s: the other 30 take 6 s more.
TEST(ProgressBar, EstimatesTheTimeLeft) {
  EXPECT_NE(progress_bar("tets", 10, 40, 2).find("6 s left"), std::string::npos);
  EXPECT_EQ(progress_bar("tets", 0, 40, 2).find("left"), std::string::npos);
}

TEST(TerminalProgress, WritesOneLineAStageWhenNobodyWatches) {
  testing::internal::CaptureStderr();
  {
    TerminalProgress progress(TerminalProgress::Style::Lines);
    progress.begin("surface", 3);
    for (int i = 0; i < 3; ++i) progress.advance(1);
    progress.begin("modal", 2);
    progress.advance(2);
  }
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2);
  EXPECT_NE(text.find("surface  3/3 in "), std::string::npos) << text;
  EXPECT_EQ(text.find('\r'), std::string::npos);
  EXPECT_EQ(text.find('\033'), std::string::npos);
}

TEST(TerminalProgress, IsCancelledByCtrlCWhileItLives) {
  {
    TerminalProgress progress(TerminalProgress::Style::Lines);
    EXPECT_FALSE(progress.cancelled());
    std::raise(SIGINT);
    EXPECT_TRUE(progress.cancelled());
    EXPECT_THROW(progress.throw_if_cancelled(), Error);
  }
  TerminalProgress next(TerminalProgress::Style::Lines);
  EXPECT_FALSE(next.cancelled());
}

}  // namespace
}  // namespace liana
