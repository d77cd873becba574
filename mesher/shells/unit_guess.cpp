#include "mesher/shells/unit_guess.h"

#include <fmt/core.h>

#include <array>
#include <cmath>

#include "mesher/base/error.h"

namespace liana {

double metres(Unit unit) {
  require(unit != Unit::Auto, "metres: a unit");
  return unit == Unit::Metre ? 1 : unit == Unit::Centimetre ? 0.01 : 0.001;
}

std::string_view name_of(Unit unit) {
  constexpr std::array<std::string_view, 4> kNames = {"auto", "metres", "centimetres", "millimetres"};
  return kNames[static_cast<size_t>(unit)];
}

UnitGuess guess_unit(const PlantSizes& sizes) {
  struct Usual {
    const double size, middle, spread;  // m; spread of the natural logarithm
  };
  // Herbs of 20 cm to trees of 45 m; leaves of 1.5 to 35 cm; twigs, petioles and lianas of 0.5 to 50 mm: two
  // spreads.
  const Usual usual[] = {
      {sizes.height, 3, 1.35}, {sizes.leaf_length, 0.07, 0.8}, {sizes.thin_branch, 0.005, 1.15}};
  std::array<double, 3> misfit{};
  constexpr Unit kUnits[] = {Unit::Metre, Unit::Centimetre, Unit::Millimetre};
  for (size_t u = 0; u < 3; ++u)
    for (const Usual& what : usual)
      if (what.size > 0)
        misfit[u] += std::pow(std::log(what.size * metres(kUnits[u]) / what.middle) / what.spread, 2) / 2;
  size_t best = 0;
  for (size_t u = 1; u < 3; ++u)
    if (misfit[u] < misfit[best]) best = u;
  double next = std::numeric_limits<double>::infinity();
  for (size_t u = 0; u < 3; ++u)
    if (u != best) next = std::min(next, misfit[u]);
  UnitGuess guess{kUnits[best], "", std::exp(misfit[best] - next)};
  const double m = metres(guess.unit);
  guess.reason = fmt::format("as {} it is {:.3g} m large", name_of(guess.unit), sizes.height * m);
  if (sizes.leaf_length > 0)
    guess.reason += fmt::format(", its leaves {:.2g} cm long", 100 * sizes.leaf_length * m);
  if (sizes.thin_branch > 0)
    guess.reason += fmt::format(", its thin branches {:.2g} mm thick", 1000 * sizes.thin_branch * m);
  return guess;
}

}  // namespace liana
