#include "runtime/app/bake/manifest_results.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "materials/cache/program_identity.h"
#include "materials/law/species_file.h"
#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "mesher/base/hash.h"

namespace liana {
namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;
using State = ItemResult::State;

uint64_t add(const std::string& bytes, uint64_t hash) {
  return hash_bytes(bytes.data(), bytes.size(), hash);
}

/// The files beside a .gltf that hold its meshes.
std::vector<fs::path> buffers_of(const fs::path& plant, const std::string& text) {
  std::vector<fs::path> files;
  const OrderedJson gltf = OrderedJson::parse(text, nullptr, false);
  if (!gltf.is_object() || !gltf.contains("buffers") || !gltf["buffers"].is_array()) return files;
  for (const OrderedJson& buffer : gltf["buffers"]) {
    if (!buffer.is_object()) continue;
    const auto uri = buffer.find("uri");
    if (uri == buffer.end() || !uri->is_string()) continue;
    const fs::path file = plant.parent_path() / uri->get<std::string>();
    std::error_code code;
    if (fs::is_regular_file(file, code)) files.push_back(file);
  }
  return files;
}

const char* state_name(State state) {
  switch (state) {
    case State::Baked:
      return "baked";
    case State::Kept:
      return "kept";
    case State::Failed:
      return "failed";
    case State::Waiting:
      break;
  }
  return "waiting";
}

OrderedJson to_json(const ManifestItem& item, const ItemResult& result) {
  return {{"plant", item.plant.string()},   {"species", item.species},
          {"output", item.output.string()}, {"state", state_name(result.state)},
          {"domains", result.domains},      {"left_out", result.left_out},
          {"seconds", result.seconds},      {"message", result.message},
          {"key", hash_text(result.key)},   {"output_hash", hash_text(result.output_hash)}};
}

std::string dump(const OrderedJson& json) {
  return json.dump(2, ' ', false, OrderedJson::error_handler_t::replace) + "\n";
}

std::string said(const ItemResult& result) {
  if (result.state == State::Failed) return "failed: " + result.message;
  if (result.left_out > 0) return fmt::format("{}, {} left out", state_name(result.state), result.left_out);
  return state_name(result.state);
}

}  // namespace

fs::path results_folder(const fs::path& manifest) {
  return fs::absolute(manifest).string() + ".results";
}

fs::path result_file(const fs::path& manifest, const ManifestItem& item) {
  const std::string output = item.output.string();
  return results_folder(manifest) /
         (item.output.stem().string() + "-" + hash_text(add(output, 0)).substr(0, 8) + ".json");
}

uint64_t key_of(const ManifestItem& item) {
  const std::string plant = read_file(item.plant);
  uint64_t key = add(plant, program_identity());
  if (item.plant.extension() == ".gltf")
    for (const fs::path& buffer : buffers_of(item.plant, plant)) key = add(read_file(buffer), key);
  key = add(read_file(find_species(item.species)), key);
  for (const std::string& option : item.options) key = add(option + '\0', key);
  return key;
}

void write_result(const fs::path& manifest, const ManifestItem& item, const ItemResult& result) {
  write_file(result_file(manifest, item), dump(to_json(item, result)));
}

ItemResult read_result(const fs::path& manifest, const ManifestItem& item, uint64_t key) {
  const fs::path file = result_file(manifest, item);
  if (!fs::exists(file)) return {};
  try {
    const OrderedJson json = OrderedJson::parse(read_file(file));
    ItemResult result;
    result.key = key;
    if (json.at("key") != hash_text(key)) return {};
    result.domains = json.at("domains"), result.left_out = json.at("left_out");
    result.seconds = json.at("seconds"), result.message = json.at("message");
    if (json.at("state") == state_name(State::Failed)) {
      result.state = State::Failed;
      return result;
    }
    if (!fs::exists(item.output)) return {};
    result.output_hash = add(read_file(item.output), 0);
    if (json.at("output_hash") != hash_text(result.output_hash)) return {};
    result.state = State::Kept;
    return result;
  } catch (const std::exception&) {  // a damaged result: the plant is baked again
    return {};
  }
}

std::string results_table(const std::vector<ManifestItem>& items, const std::vector<ItemResult>& results) {
  size_t width = 6;
  for (const ManifestItem& item : items) width = std::max(width, item.label.size());
  const auto line = [&](const auto& bake, const auto& domains, const auto& seconds, const auto& result) {
    return fmt::format("{:<{}}  {:>7}  {:>8}  {}\n", bake, width, domains, seconds, result);
  };
  std::string text = line("bake", "domains", "seconds", "result");
  std::map<State, size_t> count;
  size_t partial = 0;
  for (size_t i = 0; i < items.size(); ++i) {
    const ItemResult& result = results[i];
    ++count[result.state];
    partial += result.left_out > 0 && result.state != State::Failed;
    const bool done = result.state == State::Baked || result.state == State::Kept;
    text += line(items[i].label, done ? std::to_string(result.domains) : "-",
                 done ? fmt::format("{:.2f}", result.seconds) : "-", said(result));
  }
  text += fmt::format("{} plants: {} baked, {} kept as they were, {} failed", items.size(),
                      count[State::Baked], count[State::Kept], count[State::Failed]);
  if (count[State::Waiting]) text += fmt::format(", {} not baked yet", count[State::Waiting]);
  if (partial) text += fmt::format("; {} with domains left out", partial);
  return text + "\n";
}

std::string results_json(const std::vector<ManifestItem>& items, const std::vector<ItemResult>& results) {
  OrderedJson json{{"plants", OrderedJson::array()}};
  for (size_t i = 0; i < items.size(); ++i) json["plants"].push_back(to_json(items[i], results[i]));
  return dump(json);
}

}  // namespace liana
