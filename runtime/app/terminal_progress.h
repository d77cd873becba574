// Progress on the terminal: a bar with the stage and the time left, or a plain line per stage when nobody
// watches.
#pragma once

#include <mutex>
#include <string>

#include "mesher/base/progress.h"
#include "mesher/base/stopwatch.h"

namespace liana {

/// Writes to stderr. While it lives, the first Ctrl-C makes cancelled() true; a second one ends the process.
class TerminalProgress : public Progress {
 public:
  enum class Style { Auto, Bar, Lines };  ///< Auto: Bar on a terminal that can move its cursor

  explicit TerminalProgress(Style style = Style::Auto);
  ~TerminalProgress() override;  ///< ends the last stage
  TerminalProgress(const TerminalProgress&) = delete;
  TerminalProgress& operator=(const TerminalProgress&) = delete;

  void begin(std::string_view stage, size_t total) override;
  void advance(size_t count) override;
  bool cancelled() const override;

 private:
  void end_stage();

  bool bar_;
  std::mutex mutex_;
  std::string stage_;
  size_t total_ = 0, done_ = 0;
  Stopwatch watch_;
  double drawn_at_ = 0;  ///< s of watch_
};

/// One line of a bar, e.g. "modal    [######....] 120/378  3 s left". Stages that just began promise no time.
std::string progress_bar(std::string_view stage, size_t done, size_t total, double seconds);

}  // namespace liana
