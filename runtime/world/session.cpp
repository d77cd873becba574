#include "runtime/world/session.h"

#include <fmt/core.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>

#include "mesher/base/error.h"
#include "mesher/base/files.h"
#include "mesher/base/hash.h"

namespace liana {
namespace {

using Json = nlohmann::ordered_json;  // prints doubles so that they are read back with the same bits

constexpr int kVersion = 1;
constexpr double kLargest = 1e12;  // of any number in an act

template <class Matrix>
Json numbers(const Matrix& matrix) {
  return std::vector<double>(matrix.data(), matrix.data() + matrix.size());
}

template <class Matrix>
Matrix matrix(const Json& values) {
  Matrix result;
  if (values.size() != static_cast<size_t>(result.size()))
    throw std::invalid_argument("too few or many numbers");
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    result.data()[i] = values.at(static_cast<size_t>(i)).get<double>();
    if (!(std::abs(result.data()[i]) <= kLargest)) throw std::invalid_argument("a number that is too large");
  }
  return result;
}

Json grab_line(size_t plant, const WorldSpring& spring) {
  return {{"grab",
           {{"plant", plant},
            {"particle", spring.particle.index()},
            {"on_particle", numbers(spring.on_particle)},
            {"target", numbers(spring.target)},
            {"stiffness", numbers(spring.stiffness)},
            {"damping", numbers(spring.damping)},
            {"target_velocity", numbers(spring.target_velocity)}}}};
}

WorldSpring read_spring(const Json& grab) {
  return {.particle = ParticleId(grab.at("particle").get<uint32_t>()),
          .on_particle = matrix<Vec3>(grab.at("on_particle")),
          .target = matrix<Vec3>(grab.at("target")),
          .stiffness = matrix<Mat3>(grab.at("stiffness")),
          .damping = matrix<Mat3>(grab.at("damping")),
          .target_velocity = matrix<Vec3>(grab.at("target_velocity"))};
}

}  // namespace

SessionRecorder::SessionRecorder(World& world, const std::filesystem::path& file)
    : world_(world), file_(file), out_(file, std::ios::binary) {
  const Json head = {{"liana_session", kVersion},
                     {"time_step", world.time_step()},
                     {"step", world.stats().steps},
                     {"state", hash_text(world.state_hash())}};
  write(head.dump());
}

void SessionRecorder::write(const std::string& line) {
  errno = 0;
  out_ << line << '\n' << std::flush;
  if (!out_)
    throw Error(Error::Kind::Output,
                fmt::format("{}: cannot be written ({})", file_.string(), std::strerror(errno)),
                "check that the folder exists, is writable and has space");
}

void SessionRecorder::step() {
  world_.step();
  write(Json{{"step", world_.stats().steps}, {"state", hash_text(world_.state_hash())}}.dump());
}

void SessionRecorder::set_grab(size_t plant, const WorldSpring& spring) {
  write(grab_line(plant, spring).dump());
  world_.set_grab(plant, spring);
}

void SessionRecorder::clear_grab() {
  write(Json{{"release", true}}.dump());
  world_.clear_grab();
}

void SessionRecorder::cut(size_t plant, ParticleId particle) {
  write(Json{{"cut", {{"plant", plant}, {"particle", particle.index()}}}}.dump());
  world_.cut(plant, particle);
}

SessionReplay::SessionReplay(std::filesystem::path file) : file_(std::move(file)) {
  read(read_file(file_));
}

void SessionReplay::fail(size_t line, const std::string& what, const std::string& hint) const {
  throw Error(Error::Kind::Input, fmt::format("{}:{}: {}", file_.string(), line, what), hint);
}

void SessionReplay::read(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  std::vector<Act> acts;
  for (size_t number = 1; std::getline(lines, line) && !lines.eof(); ++number) {
    try {
      const Json entry = Json::parse(line);
      if (number == 1) {
        if (entry.at("liana_session") != kVersion || entry.at("step") != 0)
          throw std::invalid_argument("made by another version");
        time_step_ = entry.at("time_step");
        start_ = entry.at("state");
      } else if (entry.contains("step")) {
        if (entry["step"] != steps_.size() + 1)
          throw std::invalid_argument(fmt::format("not step {}, which comes next", steps_.size() + 1));
        steps_.push_back({std::move(acts), number, entry.at("state").get<std::string>()});
        acts.clear();
      } else if (entry.contains("grab")) {
        const Json& grab = entry["grab"];
        acts.push_back({Act::Kind::Grab, number, grab.at("plant").get<size_t>(), read_spring(grab)});
      } else if (entry.contains("cut")) {
        const Json& cut = entry["cut"];
        acts.push_back({Act::Kind::Cut, number, cut.at("plant").get<size_t>(), {}});
        acts.back().spring.particle = ParticleId(cut.at("particle").get<uint32_t>());
      } else if (entry.at("release") == true) {
        acts.push_back({Act::Kind::Release, number, 0, {}});
      } else {
        throw std::invalid_argument("nothing that can be done");
      }
    } catch (const std::exception& error) {
      fail(number, fmt::format("no line of a session ({})", error.what()),
           "sessions are written by `liana edit SCENE --record FILE`");
    }
  }
  if (start_.empty()) fail(1, "no session", "sessions are written by `liana edit SCENE --record FILE`");
}

void SessionReplay::act(const Act& act, World& world) {
  const std::pair asked(act.plant, act.spring.particle);
  const bool there =
      act.plant < world.plant_count() && act.spring.particle.value < world.plant(act.plant).particles.size();
  if (act.kind == Act::Kind::Release) {
    held_.reset();
    return world.clear_grab();
  }
  if (!there && !(act.kind == Act::Kind::Grab && held_ == asked))
    fail(act.line, "names a particle that is not there",
         "play the session with the scene it was recorded with");
  if (act.kind == Act::Kind::Cut) return world.cut(act.plant, act.spring.particle);
  held_ = asked;
  world.set_grab(act.plant, act.spring);
}

void SessionReplay::step(World& world) {
  const size_t index = world.stats().steps;
  require(index < steps_.size(), "SessionReplay::step: the session is over");
  const char* other =
      "the scene, its bakes and species, and this version of liana: all as when it was recorded";
  if (index == 0 && world.time_step() != time_step_)
    fail(1, fmt::format("steps of {} s, but the scene takes {} s", time_step_, world.time_step()), other);
  if (const std::string now = hash_text(world.state_hash()); index == 0 && now != start_)
    fail(1, fmt::format("the scene starts in state {}, not in {} as recorded", now, start_), other);
  for (const Act& one : steps_[index].acts) act(one, world);
  world.step();
  if (const std::string now = hash_text(world.state_hash()); now != steps_[index].state)
    fail(steps_[index].line,
         fmt::format("step {} is the first that differs: it ends in state {}, not in {} as recorded",
                     index + 1, now, steps_[index].state),
         other);
}

}  // namespace liana
