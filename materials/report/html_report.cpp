#include "materials/report/html_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

#include "materials/law/material_model.h"
#include "materials/report/model_comparison.h"
#include "materials/report/report_mesh.h"
#include "mesher/base/hash.h"

namespace liana {
namespace {

using Json = nlohmann::ordered_json;

/// Five digits: more than any curve shows, and half the bytes.
double brief(double value) {
  return std::strtod(fmt::format("{:.5g}", value).c_str(), nullptr);
}

/// Why someone should look at a domain; empty when there is no reason.
std::string doubt(const BakedDomain& domain, double parent_confidence) {
  // Below one half another parent is as likely (mesher/shells/segment.cpp lists the same).
  if (parent_confidence < 0.5)
    return fmt::format("may grow on another branch: confidence {:.2f}", parent_confidence);
  if (domain.route.find("wrap") != std::string::npos) return "wrapped: its surface is an approximation";
  if (domain.route.find("beam") != std::string::npos) return "no solid: modelled as a beam";
  return {};
}

/// How sure the parent of every domain of the bake is.
std::vector<double> parent_confidences(const SegmentedPlant& plant, const BakeResult& result) {
  std::vector<double> confidences(result.bake.domains.size(), 1);
  for (size_t i = 0; i < plant.domains.size(); ++i)
    if (result.baked_as[i].valid())
      confidences[result.baked_as[i].index()] = plant.domains[i].parent_confidence;
  return confidences;
}

/// Texts that repeat, as a list and the index of each.
struct Dictionary {
  std::map<std::string, size_t> index;
  Json texts = Json::array();
  size_t add(const std::string& text) {
    const auto [at, is_new] = index.emplace(text, texts.size());
    if (is_new) texts.push_back(text);
    return at->second;
  }
};

/// One list per quantity, as short as they can be: a plant may have 30,000 domains.
Json domains_json(const Bake& bake, const std::vector<double>& confidences, Dictionary& groups,
                  Dictionary& routes) {
  Json lists = Json::object();
  for (size_t id = 0; id < bake.domains.size(); ++id) {
    const BakedDomain& d = bake.domains[id];
    lists["name"].push_back(d.name);
    lists["parent"].push_back(d.parent.valid() ? static_cast<int64_t>(d.parent.value) : -1);
    lists["leaf"].push_back(d.kind == DomainKind::Leaf ? 1 : 0);
    lists["level"].push_back(d.level);
    lists["group"].push_back(groups.add(d.group));
    lists["route"].push_back(routes.add(d.route));
    lists["doubt"].push_back(doubt(d, confidences[id]));
    lists["solved_as"].push_back(d.solved_as.value);
    lists["tets"].push_back(d.tets);
    const DomainMaterial& m = d.material;
    const std::pair<const char*, double> numbers[] = {{"length", d.length},
                                                      {"mass", d.mass},
                                                      {"nu0", d.default_frequency},
                                                      {"nu", m.frequency},
                                                      {"E", d.youngs_modulus},
                                                      {"rho", d.density},
                                                      {"xi", m.damping_factor},
                                                      {"dM", m.mass_damping},
                                                      {"dK", m.stiffness_damping},
                                                      {"alpha_m", m.mass_scaling},
                                                      {"alpha_k", d.stiffness_scaling}};
    for (const auto& [key, value] : numbers) lists[key].push_back(brief(value));
  }
  return lists;
}

Json group_json(const std::string& name, const GroupLaw& law) {
  const DampingLaw& d = law.damping;
  const Json damping = d.constant_rayleigh ? Json{{"dM", d.mass_damping}, {"dK", d.stiffness_damping}}
                                           : Json{{"low_frequency", d.low_frequency},
                                                  {"high_frequency", d.high_frequency},
                                                  {"low_factor", d.low_factor},
                                                  {"high_factor", d.high_factor},
                                                  {"kappa", d.kappa},
                                                  {"delta", d.delta}};
  return {{"name", name},
          {"frequency", law.reference_frequency},
          {"length", law.reference_length},
          {"epsilon1", law.epsilon1},
          {"c2", law.c2},
          {"epsilon2", law.epsilon2},
          {"damping", damping}};
}

Json models_json(const Bake& bake) {
  Json models = Json::array();
  const ModelComparison comparison = compare_models(bake);
  for (size_t i = 0; i < comparison.models.size(); ++i) {
    Json frequencies = Json::array();
    for (const double frequency : comparison.models[i].frequencies) frequencies.push_back(brief(frequency));
    models.push_back({{"name", model_name(kMaterialModels[i])},
                      {"nu", frequencies},
                      {"notes", comparison.models[i].notes}});
  }
  return models;
}

Json mesh_json(const ReportMesh& mesh) {
  Json pieces = Json::array();
  for (const ReportMesh::Piece& piece : mesh.pieces)
    pieces.push_back({piece.id, piece.vertices, piece.shape});
  return {{"origin", {mesh.origin.x(), mesh.origin.y(), mesh.origin.z()}},
          {"step", mesh.step},
          {"pieces", pieces},
          {"shapes", mesh.shapes},
          {"index_bytes", mesh.index_bytes},
          {"positions", mesh.positions},
          {"triangles", mesh.triangles}};
}

Json report_json(const SegmentedPlant& plant, const BakeResult& result) {
  const Bake& bake = result.bake;
  const StageSeconds& s = result.seconds;
  Dictionary groups, routes;
  Json domains = domains_json(bake, parent_confidences(plant, result), groups, routes), laws = Json::array();
  for (const auto& name : groups.texts) laws.push_back(group_json(name, bake.law.group(name)));
  return {{"plant", bake.plant},
          {"species", bake.law.species},
          {"model", model_name(bake.law.model.model)},
          {"plant_hash", hash_text(bake.plant_hash)},
          {"species_hash", hash_text(bake.species_hash)},
          {"seconds",
           {{"read", brief(s.read)},
            {"surface", brief(s.surface)},
            {"tets", brief(s.tets)},
            {"modal", brief(s.modal)},
            {"laws", brief(s.laws)},
            {"total", brief(s.total)}}},
          {"notes", result.notes},
          {"failed", bake.failed},
          {"groups", laws},
          {"routes", routes.texts},
          {"domains", domains},
          {"models", models_json(bake)},
          {"mesh", mesh_json(report_mesh(plant, result.baked_as))}};
}

std::string_view page_file(std::string_view name) {
  const auto found = std::find_if(kPageFiles.begin(), kPageFiles.end(),
                                  [&](const PageFile& file) { return file.name == name; });
  require(found != kPageFiles.end(), "a file of the report page is not embedded");
  return found->text;
}

/// page.html with every {{file}} replaced by what the file holds, and {{data}} by the data.
std::string filled(const std::string& data) {
  const std::string_view page = page_file("page.html");
  std::string text;
  for (size_t at = 0;;) {
    const size_t open = page.find("{{", at);
    text += page.substr(at, open - at);
    if (open == std::string_view::npos) return text;
    const size_t close = page.find("}}", open);
    require(close != std::string_view::npos, "page.html: {{ without }}");
    const std::string_view name = page.substr(open + 2, close - open - 2);
    text += name == "data" ? std::string_view(data) : page_file(name);
    at = close + 2;
  }
}

}  // namespace

std::string html_report(const SegmentedPlant& plant, const BakeResult& result) {
  // Names come from foreign files: bytes that are no UTF-8 are replaced, and nothing may end the script
  // early.
  const std::string json = report_json(plant, result).dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string data;
  for (const char letter : json) data += letter == '<' ? "\\u003c" : std::string(1, letter);
  return filled(data);
}

}  // namespace liana
