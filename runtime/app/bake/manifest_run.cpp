#include "runtime/app/bake/manifest_run.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "mesher/base/files.h"
#include "mesher/base/hash.h"
#include "mesher/base/parallel.h"
#include "mesher/base/stopwatch.h"
#include "runtime/app/bake/manifest_results.h"
#include "runtime/app/child_process.h"
#include "runtime/app/terminal_progress.h"
#include "runtime/app/verbs.h"

namespace liana {
namespace {

namespace fs = std::filesystem;
using State = ItemResult::State;

/// What the child said went wrong: "liana: ..." of its log.
std::string complaint(const fs::path& log, int exit_code) {
  const std::string text = read_file(log);
  constexpr std::string_view kMark = "liana: ";
  for (size_t line = 0; line < text.size(); line = text.find('\n', line) + 1) {
    const size_t end = std::min(text.find('\n', line), text.size());
    if (text.compare(line, kMark.size(), kMark) == 0)
      return text.substr(line + kMark.size(), end - line - kMark.size());
    if (end == text.size()) break;
  }
  if (exit_code > 128) return fmt::format("ended by signal {}; see {}", exit_code - 128, log.string());
  return fmt::format("exit code {}; see {}", exit_code, log.string());
}

class Runner {
 public:
  Runner(const ManifestRun& run, Progress& progress) : run_(run), progress_(progress) {
    jobs_ = run.jobs ? run.jobs : default_thread_count();
    threads_ = run.threads ? run.threads : std::max(1u, default_thread_count() / jobs_);
  }

  ItemResult bake(const ManifestItem& item) const {
    progress_.throw_if_cancelled();
    ItemResult result;
    try {
      result = recall(item);
      if (result.state == State::Kept) return result;
      spawn(item, result);
    } catch (const Error& error) {
      if (error.kind == Error::Kind::Cancelled) throw;
      result.state = State::Failed, result.message = error.what();
    }
    write_result(run_.manifest, item, result);
    return result;
  }

  /// Without baking it.
  ItemResult known(const ManifestItem& item) const {
    try {
      return recall(item);
    } catch (const Error& error) {
      ItemResult result;
      result.state = State::Failed, result.message = error.what();
      return result;
    }
  }

  unsigned jobs() const { return jobs_; }

 private:
  ItemResult recall(const ManifestItem& item) const {
    const uint64_t key = key_of(item);
    ItemResult result = read_result(run_.manifest, item, key);
    result.key = key;
    return result;
  }

  void spawn(const ManifestItem& item, ItemResult& result) const {
    const fs::path file = result_file(run_.manifest, item);
    const fs::path log = fs::path(file).replace_extension(".log"),
                   report = fs::path(file).replace_extension(".report.json");
    std::error_code code;  // the child says what is wrong with the folder
    fs::create_directories(item.output.parent_path(), code);
    std::vector<std::string> arguments{"bake",      item.plant.string(),     "--species", item.species,
                                       "-o",        item.output.string(),    "--report",  report.string(),
                                       "--threads", std::to_string(threads_)};
    arguments.insert(arguments.end(), item.options.begin(), item.options.end());
    const Stopwatch watch;
    const int exit_code = run_self(arguments, log, progress_);
    result.seconds = watch.seconds();
    result.message.clear();
    if (exit_code != kSuccess && exit_code != kPartial) {
      result.state = State::Failed, result.message = complaint(log, exit_code);
      return;
    }
    const auto json = nlohmann::json::parse(read_file(report));
    const std::string bake = read_file(item.output);
    result.domains = json.at("domains").size(), result.left_out = json.at("failed").size();
    result.output_hash = hash_bytes(bake.data(), bake.size());
    result.state = State::Baked;
  }

  const ManifestRun& run_;
  Progress& progress_;
  unsigned jobs_ = 1, threads_ = 1;
};

}  // namespace

int run_manifest(const ManifestRun& run) {
  std::vector<ManifestItem> items;
  {
    const std::vector<ManifestItem> all = read_manifest(run.manifest);
    for (size_t i = 0; i < all.size(); ++i)
      if (run.shard.has(i)) items.push_back(all[i]);
  }
  const fs::path folder = results_folder(run.manifest);
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) throw Error(Error::Kind::Output, folder.string() + ": " + code.message());

  std::vector<ItemResult> results(items.size());
  {
    TerminalProgress progress;
    const Runner runner(run, progress);
    progress.begin(run.merge ? "merge" : "plants", items.size());
    try {
      parallel_for(items.size(), runner.jobs(), [&](size_t i, unsigned) {
        results[i] = run.merge ? runner.known(items[i]) : runner.bake(items[i]);
        progress.advance(1);
      });
    } catch (const Error& error) {
      if (error.kind != Error::Kind::Cancelled) throw;
      const auto done = std::count_if(results.begin(), results.end(),
                                      [](const ItemResult& r) { return r.state != State::Waiting; });
      throw Error(Error::Kind::Cancelled, fmt::format("cancelled after {} of {} plants", done, items.size()),
                  "the same command goes on from there");
    }
  }
  fmt::print("{}", results_table(items, results));
  if (run.shard.count == 1) {
    write_file(folder / "summary.json", results_json(items, results));
    fmt::print("summary: {}\n", (folder / "summary.json").string());
  }
  const bool all =
      std::all_of(results.begin(), results.end(), [](const ItemResult& r) { return r.complete(); });
  return all ? kSuccess : kPartial;
}

}  // namespace liana
