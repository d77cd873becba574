#include "mesher/io/mtg_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "mesher/base/error.h"
#include "mesher/io/text_cursor.h"

namespace liana {
namespace {

constexpr size_t kMaxEntities = 5'000'000, kMaxColumns = 4096;

struct Entity {
  int scale = 0;        // 0: its class is not declared
  int complex_of = -1;  // what it is a part of
  int grows_from = -1;  // geometrically
  bool begins_axis = false;
  int top = -1;   // the last of its parts along its own axis
  int node = -1;  // in the graph, if it has a position
};

std::vector<std::string_view> cells_of(std::string_view line) {
  std::vector<std::string_view> cells;
  while (cells.size() < kMaxColumns) {
    const size_t end = line.find('\t');
    cells.push_back(without_outer_blanks(line.substr(0, end)));
    if (end == std::string_view::npos) break;
    line.remove_prefix(end + 1);
  }
  return cells;
}

class MtgParser {
 public:
  MtgParser(std::string_view bytes, const std::string& file) : lines_(bytes), file_(file) {}

  PlantGraph parse() {
    std::string_view line;
    while (lines_.next(line)) {
      const std::string_view text = without_outer_blanks(line);
      if (text.empty() || text[0] == '#') continue;
      if (begins_section(text)) continue;
      if (section_ == "CLASSES") declare_class(text);
      if (section_ == "MTG" && text.starts_with("ENTITY-CODE"))
        header(line);
      else if (section_ == "MTG" && first_feature_ > 0)
        entity_line(line);
      else if (section_ == "MTG")
        throw error("an entity before the line ENTITY-CODE", kForm);
    }
    finish();
    return std::move(graph_);
  }

 private:
  static constexpr const char* kForm =
      "an MTG has the sections CODE, CLASSES, DESCRIPTION, FEATURES and MTG; see the OpenAlea documentation";

  Error error(const std::string& reason, const std::string& hint) const {
    return Error(Error::Kind::Input, fmt::format("{}:{}: {}", file_, lines_.number(), reason), hint);
  }

  bool begins_section(std::string_view text) {
    for (const std::string_view name : {"CODE", "CLASSES", "DESCRIPTION", "FEATURES", "MTG"}) {
      if (!text.starts_with(name)) continue;
      const std::string_view rest = without_outer_blanks(text.substr(name.size()));
      if (!rest.starts_with(":")) continue;
      section_ = name;
      return true;
    }
    return false;
  }

  void declare_class(std::string_view text) {
    const std::string_view symbol = take_word(text);
    if (const auto scale = to_number<int>(take_word(text)); scale && *scale >= 0 && symbol.size() <= 64)
      scales_[std::string(symbol)] = *scale;
  }

  void header(std::string_view line) {
    const std::vector<std::string_view> cells = cells_of(line);
    first_feature_ = cells.size();
    for (size_t c = 1; c < cells.size(); ++c) {
      if (cells[c].empty()) continue;
      first_feature_ = std::min(first_feature_, c);
      for (size_t axis = 0; axis < 3; ++axis)
        if (cells[c] == std::string(2, "XYZ"[axis]) || cells[c] == std::string(1, "XYZ"[axis]))
          axis_column_[axis] = c;
      for (const std::string_view name : {"TopDia", "TopDiameter", "Diameter", "diameter", "Dia"})
        if (cells[c] == name && diameter_column_ == 0) diameter_column_ = c;
    }
    for (const size_t column : axis_column_)
      if (column == 0)
        throw error("the table has no columns XX, YY and ZZ",
                    "only digitised plants, with a position per entity, can become branches");
  }

  /// The class of a label: the longest declared symbol it starts with, else its letters.
  int scale_of(std::string_view label) const {
    for (size_t length = label.size(); length > 0; --length)
      if (const auto known = scales_.find(std::string(label.substr(0, length))); known != scales_.end())
        return known->second;
    return 0;
  }

  int top_of(int entity) const {
    while (entity >= 0 && entities_[entity].top >= 0) entity = entities_[entity].top;
    return entity;
  }

  int create(char edge, std::string_view label, int reference) {
    Entity entity;
    entity.scale = scale_of(label);
    const auto coarser = [&](int other) { return entities_[other].scale < entity.scale; };
    if (edge == '/') {
      while (reference >= 0 && entity.scale > 0 && !coarser(reference))
        reference = entities_[reference].complex_of;
      entity.complex_of = entity.grows_from = reference;
    } else {
      if (reference < 0)
        throw error(fmt::format("'{}{}' has nothing that it grows from", edge, shown(label)), kForm);
      while (entity.scale > 0 && entities_[reference].scale > entity.scale &&
             entities_[reference].complex_of >= 0)
        reference = entities_[reference].complex_of;
      entity.complex_of = entities_[reference].complex_of;
      entity.grows_from = top_of(reference);
      entity.begins_axis = edge == '+';
    }
    const auto index = static_cast<int>(entities_.size());
    if (edge != '+' && entity.complex_of >= 0) entities_[entity.complex_of].top = index;
    entities_.push_back(entity);
    if (entities_.size() > kMaxEntities)
      throw error(fmt::format("more than {} entities", kMaxEntities), "split the file");
    return index;
  }

  /// A topological cell such as ^/S1, +A1, /P1/A1/U1<U2 or <<U9 (all from the one before up to U9).
  int cell(std::string_view text, int reference) {
    bool any = false;
    while (!text.empty()) {
      char edge = '/';
      if (std::string_view("/<+").find(text[0]) != std::string_view::npos)
        edge = text[0], text.remove_prefix(1);
      else if (any)
        throw error(fmt::format("'{}' is no entity", shown(text)), kForm);
      const bool range = !text.empty() && text[0] == edge && edge != '/';
      if (range) text.remove_prefix(1);
      const std::string_view label = text.substr(0, text.find_first_of("/<+^"));
      if (label.empty() || !(std::isalpha((unsigned char)label[0]) || label[0] == '$' || label[0] == '_'))
        throw error(fmt::format("'{}' is no entity", shown(text.empty() ? "/" : text)), kForm);
      text.remove_prefix(label.size());
      if (!text.empty() && text[0] == '^') throw error("^ inside of an entity", kForm);
      reference = create(edge, label, reference);
      skipped_ranges_ += range;
      any = true;
    }
    if (!any) throw error("an empty entity", kForm);
    return reference;
  }

  void entity_line(std::string_view line) {
    const std::vector<std::string_view> cells = cells_of(line);
    size_t column = 0;
    while (column < std::min(first_feature_, cells.size()) && cells[column].empty()) ++column;
    if (column >= std::min(first_feature_, cells.size())) return;  // features of nothing
    std::string_view text = cells[column];
    const bool same_column = text[0] == '^';
    if (same_column) text.remove_prefix(1);
    if (text.empty()) throw error("an empty entity", kForm);
    if (columns_.size() <= column) columns_.resize(column + 1);
    const Column& base = columns_[same_column || column == 0 ? column : column - 1];
    const int reference =
        text[0] == '+' || text[0] == '<' ? (base.axis >= 0 ? base.axis : base.last) : base.last;
    const char first_edge = text[0];
    const int entity = cell(text, reference);
    columns_.resize(column + 1);
    Column& own = columns_[column];
    own.last = entity;
    // ^+X hangs a branch on the column's axis, which goes on after it.
    if (!same_column || first_edge != '+' || own.axis < 0) own.axis = entity;
    place(entity, cells);
  }

  void place(int entity, const std::vector<std::string_view>& cells) {
    const auto number = [&](size_t column) -> std::optional<double> {
      if (column == 0 || column >= cells.size() || cells[column].empty()) return std::nullopt;
      const auto value = to_number<double>(cells[column]);
      if (!value) {
        if (cells[column] == "NA" || cells[column] == "nan" || cells[column] == "-") return std::nullopt;
        throw error(fmt::format("'{}' is not a number", shown(cells[column])),
                    "write numbers with a point, and nothing for unknown");
      }
      return std::isfinite(*value) ? value : std::nullopt;
    };
    GraphNode node;
    for (size_t axis = 0; axis < 3; ++axis) {
      const auto value = number(axis_column_[axis]);
      if (!value) {
        ++without_position_;
        return;
      }
      node.position[static_cast<long>(axis)] = *value;
    }
    if (const auto diameter = number(diameter_column_); diameter && *diameter > 0)
      node.radius = *diameter * 0.001 / 2;
    node.begins_axis = entities_[entity].begins_axis;
    int below = entities_[entity].grows_from;
    for (; below >= 0 && entities_[below].node < 0; below = entities_[below].grows_from)
      node.begins_axis = node.begins_axis || entities_[below].begins_axis;
    node.parent = below >= 0 ? entities_[below].node : -1;
    entities_[entity].node = static_cast<int>(graph_.nodes.size());
    graph_.nodes.push_back(node);
  }

  void finish() {
    if (first_feature_ == 0)
      throw Error(Error::Kind::Input, file_ + ": has no section MTG with a line ENTITY-CODE", kForm);
    if (graph_.nodes.size() < 2)
      throw Error(Error::Kind::Input,
                  fmt::format("{}: {} of its {} entities have a position", file_, graph_.nodes.size(),
                              entities_.size()),
                  "only digitised plants, with XX, YY and ZZ per entity, can become branches");
    if (without_position_)
      graph_.notes.push_back(fmt::format("{} of {} entities have no position and only link others",
                                         without_position_, entities_.size()));
    if (skipped_ranges_)
      graph_.notes.push_back(fmt::format("{} ranges (<< or ++) taken as one entity each", skipped_ranges_));
    if (diameter_column_ == 0) graph_.notes.emplace_back("the file has no column TopDia");
  }

  struct Column {
    int last = -1;  // the entity last written in it
    int axis = -1;  // the last that is not a branch hung on the others
  };

  LineCursor lines_;
  const std::string& file_;
  PlantGraph graph_;
  std::string section_;
  std::map<std::string, int> scales_;
  std::vector<Entity> entities_;
  std::vector<Column> columns_;
  size_t first_feature_ = 0, axis_column_[3] = {0, 0, 0}, diameter_column_ = 0;
  size_t without_position_ = 0, skipped_ranges_ = 0;
};

}  // namespace

PlantGraph parse_mtg(std::string_view bytes, const std::string& file) {
  return MtgParser(bytes, file).parse();
}

}  // namespace liana
