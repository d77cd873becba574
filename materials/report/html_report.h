// A bake as one page for a browser: the plant in colours, curves, histograms, and a table of what was done.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "materials/pipeline/bake_plant.h"

namespace liana {

/// A file of report_page/, embedded at build time.
struct PageFile {
  std::string_view name;  ///< as "page.html"
  std::string_view text;
};
extern const std::vector<PageFile> kPageFiles;

/// One HTML file that needs nothing else and no network. `plant` is what `result` was baked from. Positions
/// are rounded to 1/65535 of the plant's size.
std::string html_report(const SegmentedPlant& plant, const BakeResult& result);

}  // namespace liana
