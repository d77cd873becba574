// read_species_file on any bytes: a law with all numbers in their ranges and a source for each, or an Error.
// What species_toml writes of it is read back with the same numbers.
#include <optional>

#include "materials/law/law_numbers.h"
#include "materials/law/species_file.h"
#include "materials/law/species_writer.h"
#include "mesher/base/error.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::optional<liana::SpeciesFile> species;
  try {
    species = liana::read_species_file(liana::FuzzFile(data, size, "fuzz.toml").path());
  } catch (const liana::Error&) {
    return 0;
  }
  for (const liana::SourcedNumber& number : species->numbers)
    liana::require(!number.source.empty(), "a source for every number");
  liana::check(species->law, "fuzz.toml");

  const std::string text = liana::species_toml(*species, "written by the fuzzer");
  const liana::FuzzFile written(reinterpret_cast<const uint8_t*>(text.data()), text.size(), "written.toml");
  const liana::SpeciesLaw again = liana::read_species_file(written.path()).law;
  liana::require(again.species == species->law.species, "the name survives");
  liana::require(again.groups.size() == species->law.groups.size(), "groups survive");
  for (const auto& [name, group] : species->law.groups) {
    const liana::GroupLaw& other = again.groups.at(name);
    liana::require(other.reference_frequency == group.reference_frequency && other.epsilon1 == group.epsilon1,
                   "numbers survive");
    liana::require(other.match.name == group.match.name, "matches survive");
  }
  return 0;
}
