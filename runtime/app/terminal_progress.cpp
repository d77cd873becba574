#include "runtime/app/terminal_progress.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace liana {
namespace {

// Written by a signal handler in whichever thread it comes, read by all.
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void remember_interrupt(int) {
  interrupted = true;
  std::signal(SIGINT, SIG_DFL);
}

bool terminal_can_redraw() {
  const char* kind = std::getenv("TERM");
  return isatty(STDERR_FILENO) && kind && std::string_view(kind) != "dumb";
}

}  // namespace

std::string progress_bar(std::string_view stage, size_t done, size_t total, double seconds) {
  constexpr size_t kWidth = 30;
  const size_t filled = total == 0 ? kWidth : kWidth * std::min(done, total) / total;
  std::string line =
      fmt::format("{:<8} [{:#<{}}{:.<{}}] {}/{}", stage, "", filled, "", kWidth - filled, done, total);
  if (seconds > 0.5 && done > 0 && done < total)
    line += fmt::format("  {:.0f} s left",
                        seconds * static_cast<double>(total - done) / static_cast<double>(done));
  return line;
}

TerminalProgress::TerminalProgress(Style style)
    : bar_(style == Style::Bar || (style == Style::Auto && terminal_can_redraw())) {
  interrupted = false;
  std::signal(SIGINT, remember_interrupt);
}

TerminalProgress::~TerminalProgress() {
  end_stage();
  std::signal(SIGINT, SIG_DFL);
}

void TerminalProgress::begin(std::string_view stage, size_t total) {
  std::lock_guard lock(mutex_);
  end_stage();
  stage_ = stage, total_ = total, done_ = 0;
  watch_ = Stopwatch();
  drawn_at_ = 0;
}

void TerminalProgress::advance(size_t count) {
  std::lock_guard lock(mutex_);
  done_ += count;
  constexpr double kRedraw = 0.1;  // s: often enough for the eye
  const double now = watch_.seconds();
  if (!bar_ || now - drawn_at_ < kRedraw) return;
  drawn_at_ = now;
  fmt::print(stderr, "\r{}\033[K", progress_bar(stage_, done_, total_, now));
  std::fflush(stderr);
}

bool TerminalProgress::cancelled() const {
  return interrupted;
}

void TerminalProgress::end_stage() {
  if (stage_.empty()) return;
  fmt::print(stderr, "{}{:<8} {}/{} in {:.2f} s{}\n", bar_ ? "\r" : "", stage_, done_, total_,
             watch_.seconds(), bar_ ? "\033[K" : "");
  stage_.clear();
}

}  // namespace liana
