#include "runtime/world/scene/scene_wind.h"

#include <fmt/core.h>

#include <cmath>

#include "mesher/base/fixed_math.h"

namespace liana {
namespace {

EmitterParameters read_emitter(const TomlTable& table) {
  EmitterParameters emitter;
  const std::string shape = table.text_or("shape", "disc");
  if (shape != "disc" && shape != "box") table.fail("shape", "must be \"disc\" or \"box\"");
  emitter.center = table.vector("center");
  emitter.direction = table.vector("direction");
  if (emitter.direction.norm() < 1e-9) table.fail("direction", "must not be zero");
  emitter.speed = table.number("speed", 0.1, 60);
  if (shape == "disc") {
    emitter.radius = table.number("radius", 0.01, 100);
  } else {
    emitter.shape = EmitterParameters::Shape::Box;
    emitter.width = table.number("width", 0.01, 200);
    emitter.height = table.number("height", 0.01, 200);
  }
  emitter.turbulence = table.number_or("turbulence", emitter.turbulence, 0, 1);
  emitter.turbulence_length = table.number_or("turbulence_length", emitter.turbulence_length, 0.01, 1000);
  emitter.gust = table.number_or("gust", emitter.gust, 0, 1);
  emitter.gust_period = table.number_or("gust_period", emitter.gust_period, 0.1, 600);
  table.refuse_unknown_keys();
  return emitter;
}

/// m from an emitter's middle to its rim.
double rim(const EmitterParameters& e) {
  return e.shape == EmitterParameters::Shape::Disc ? e.radius : fixed::hypot(e.width, e.height) / 2;
}

/// What an emitter blows through in a second and a half, and as much room around as the emitter is wide.
void default_domain(SphWindParameters& air) {
  Eigen::AlignedBox3d box;
  for (const EmitterParameters& e : air.emitters)
    for (const double ahead : {0.0, 1.5 * e.speed}) {
      const Vec3 place = e.center + ahead * e.direction.normalized(), margin = Vec3::Constant(2 * rim(e));
      box.extend(place - margin), box.extend(place + margin);
    }
  air.low = box.min(), air.high = box.max();
}

SphWindParameters read_air(const TomlTable& wind, const std::vector<TomlTable>& emitters, uint64_t seed) {
  SphWindParameters air;
  air.seed = seed;
  for (const TomlTable& emitter : emitters) air.emitters.push_back(read_emitter(emitter));
  default_domain(air);
  if (const auto table = wind.table("air")) {
    air.spacing = table->number_or("spacing", air.spacing, 0.01, 10);
    air.max_particles = static_cast<size_t>(table->integer_or("max_particles", 10000, 1, 1'000'000));
    air.low = table->vector_or("low", air.low), air.high = table->vector_or("high", air.high);
    if (!((air.high - air.low).minCoeff() >= 2 * air.spacing))
      table->fail("low", "must lie below 'high' by at least twice the spacing in every direction");
    if ((air.high - air.low).maxCoeff() > 1e4 * air.spacing)
      table->fail("spacing",
                  fmt::format("is finer than a ten thousandth of the domain: choose at least {:.3g} m",
                              1e-4 * (air.high - air.low).maxCoeff()));
    table->refuse_unknown_keys();
  }
  for (size_t i = 0; i < emitters.size(); ++i)
    if ((air.emitters[i].center.array() < air.low.array()).any() ||
        (air.emitters[i].center.array() > air.high.array()).any())
      emitters[i].fail("center", "lies outside of the air's domain", "set low and high in [wind.air]");
  return air;
}

}  // namespace

SceneWind read_scene_wind(const TomlTable& table, uint64_t scene_seed) {
  SceneWind wind;
  const std::vector<TomlTable> emitters = table.tables("emitter");
  const std::string kind = table.text_or("kind", "gust");
  if (kind != "gust" && kind != "ambient") table.fail("kind", "must be \"gust\" or \"ambient\"");
  wind.velocity = emitters.empty() || kind == "ambient" ? table.vector("velocity")
                                                        : table.vector_or("velocity", Vec3::Zero());
  if (wind.velocity.norm() > 100) table.fail("velocity", "is above 100 m/s, which no plant meets");
  if (kind == "ambient") {
    wind.kind = SceneWind::Kind::Ambient;
    if (wind.velocity.norm() < 1e-3) table.fail("velocity", "must not be zero for an ambient wind");
    AmbientParameters& ambient = wind.ambient;
    ambient.mean = wind.velocity;
    ambient.intensity = table.number_or("turbulence", ambient.intensity, 0, 1);
    ambient.length_scale = table.number_or("length_scale", ambient.length_scale, 0.1, 1000);
    ambient.coherence_decay = table.number_or("coherence_decay", ambient.coherence_decay, 0, 100);
    ambient.seed = static_cast<uint64_t>(
        table.integer_or("seed", static_cast<int64_t>(scene_seed), 0, int64_t{1} << 53));
  } else {
    wind.gust = table.number_or("gust", wind.gust, 0, 3);
    wind.gust_period = table.number_or("gust_period", wind.gust_period, 1, 30);
  }
  wind.show_air = table.flag_or("show_air", false);
  if (!emitters.empty())
    wind.air = read_air(table, emitters, scene_seed);
  else if (table.has("air"))
    table.fail("air", "needs an emitter",
               "[[wind.emitter]] center = [-2, 1, 0] direction = [1, 0, 0] speed = 5 radius = 0.5");
  table.refuse_unknown_keys();
  return wind;
}

}  // namespace liana
