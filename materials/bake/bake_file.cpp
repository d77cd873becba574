#include "materials/bake/bake_file.h"

#include <fmt/core.h>

#include "materials/bake/bake_check.h"
#include "materials/bake/byte_stream.h"
#include "materials/law/law_numbers.h"
#include "mesher/base/files.h"
#include "mesher/base/hash.h"

namespace liana {
namespace {

constexpr std::string_view kMagic = "LIANABK\n";
constexpr size_t kHeaderSize = 8 + 4 + 4 + 8 + 8;

// One description of the layout serves both directions: `stream` is a Writer, which copies the fields out, or
// a Reader, which fills them in.
struct Writer {
  ByteWriter out;
  uint32_t version = kBakeVersion;
  template <class Number>
  void number(const Number& value) {
    out.number(value);
  }
  void text(const std::string& value) { out.text(value); }
  template <class List>
  void count(const List& list, size_t) {
    out.number(static_cast<uint32_t>(list.size()));
  }
};

struct Reader {
  ByteReader in;
  uint32_t version;
  template <class Number>
  void number(Number& value) {
    value = in.number<Number>();
  }
  void text(std::string& value) { value = in.text(); }
  template <class List>
  void count(List& list, size_t least_bytes) {
    list.resize(in.count(least_bytes));
  }
};

template <class Stream, class Vector>
void vector(Stream& stream, Vector& value) {
  for (int axis = 0; axis < 3; ++axis) stream.number(value[axis]);
}

void flag(Writer& stream, bool value) {
  stream.out.number(static_cast<uint8_t>(value));
}
void flag(Reader& stream, bool& value) {
  value = stream.in.number<uint8_t>() != 0;
}

// The kind as its number and -1 for any.
void match(Writer& stream, const GroupMatch& match) {
  stream.text(match.name);
  stream.out.number(static_cast<int32_t>(match.kind ? static_cast<int>(*match.kind) : -1));
  stream.out.number(static_cast<int32_t>(match.level));
}
void match(Reader& stream, GroupMatch& match) {
  stream.text(match.name);
  const auto kind = stream.in.number<int32_t>();
  if (kind < -1 || kind > 1) stream.in.fail("holds a group of neither branches nor leaves");
  if (kind >= 0) match.kind = static_cast<DomainKind>(kind);
  match.level = stream.in.number<int32_t>();
}

template <class Stream, class Group>
void group(Stream& stream, Group& law) {
  const auto number = [&](const NumberRange&, auto& value) { stream.number(value); };
  for_each_number_of_group(law, number);
  for_each_optional_number_of_group(law, [&](const NumberRange& range, auto& value) {
    if (range.key != kModulusOfRupture || stream.version > 3) stream.number(value);
  });
  flag(stream, law.damping.constant_rayleigh);
  for_each_number_of_damping(law.damping, number);
  match(stream, law.match);
}

void groups(Writer& stream, const std::map<std::string, GroupLaw>& laws) {
  stream.out.number(static_cast<uint32_t>(laws.size()));
  for (const auto& [name, law] : laws) stream.text(name), group(stream, law);
}

void groups(Reader& stream, std::map<std::string, GroupLaw>& laws) {
  constexpr size_t kLeastBytes = 4 + (5 + 4) * 8 + 1 + 2 * 8 + 3 * 4;
  for (uint32_t left = stream.in.count(kLeastBytes); left > 0; --left) {
    const std::string name = stream.in.text();
    group(stream, laws[name]);
  }
}

template <class Stream, class Station>
void station(Stream& stream, Station& station) {
  vector(stream, station.position);
  stream.number(station.half_width);
  stream.number(station.half_thickness);
}

template <class Stream, class Domain>
void domain(Stream& stream, Domain& domain) {
  stream.text(domain.name);
  stream.number(domain.parent.value);
  stream.number(domain.kind);
  stream.number(domain.level);
  stream.text(domain.group);
  stream.number(domain.length);
  stream.number(domain.mass);
  stream.number(domain.tets);
  stream.number(domain.dof);
  stream.number(domain.default_frequency);
  auto& material = domain.material;
  for (auto* value : {&material.frequency, &material.mass_scaling, &material.damping_factor,
                      &material.mass_damping, &material.stiffness_damping})
    stream.number(*value);
  stream.number(domain.stiffness_scaling);
  stream.number(domain.youngs_modulus);
  stream.number(domain.density);
  stream.text(domain.route);
  stream.number(domain.solved_as.value);
  stream.count(domain.centreline, 5 * 8);
  for (auto& each : domain.centreline) station(stream, each);
  vector(stream, domain.flat_normal);
  stream.number(domain.stiffness_ratio);
}

template <class Stream, class BakeType>
void payload(Stream& stream, BakeType& bake) {
  stream.text(bake.plant);
  stream.number(bake.plant_hash);
  stream.number(bake.species_hash);
  stream.text(bake.law.species);
  for_each_number_of_material(bake.law.default_material,
                              [&](const NumberRange&, auto& value) { stream.number(value); });
  stream.number(bake.law.model.model);
  for_each_number_of_model(bake.law.model, [&](const NumberRange&, auto& value) { stream.number(value); });
  groups(stream, bake.law.groups);
  constexpr size_t kLeastBytes = 3 * 4 + 20 * 8;
  stream.count(bake.domains, kLeastBytes);
  for (auto& each : bake.domains) domain(stream, each);
  stream.count(bake.failed, 4);
  for (auto& each : bake.failed) stream.text(each);
}

[[noreturn]] void refuse(const std::string& name, const std::string& what, const std::string& hint) {
  throw Error(Error::Kind::Input, name + ": " + what, hint);
}

constexpr const char* kBakeAgain = "bake it again: liana bake PLANT --species NAME -o FILE";

}  // namespace

bool is_bake(std::string_view bytes) {
  return bytes.starts_with(kMagic);
}

std::string encode_bake(const Bake& bake) {
  Writer body;
  payload(body, bake);
  const std::string& bytes = body.out.bytes();
  ByteWriter file;
  for (char letter : kMagic) file.number(letter);
  file.number(kBakeVersion);
  file.number(uint32_t{0});
  file.number(static_cast<uint64_t>(bytes.size()));
  file.number(hash_bytes(bytes.data(), bytes.size()));
  return file.bytes() + bytes;
}

Bake decode_bake(std::string_view bytes, const std::string& name) {
  if (!is_bake(bytes)) refuse(name, "is not a bake", "make one: liana bake PLANT --species NAME -o FILE");
  ByteReader header(bytes, name);
  for (size_t i = 0; i < kMagic.size(); ++i) header.number<char>();
  const auto version = header.number<uint32_t>();
  if (version < kOldestBakeVersion || version > kBakeVersion)
    refuse(name,
           fmt::format("is a bake of version {}; this program reads versions {} to {}", version,
                       kOldestBakeVersion, kBakeVersion),
           kBakeAgain);
  if (header.number<uint32_t>() != 0) refuse(name, "has a damaged header", kBakeAgain);
  const auto size = header.number<uint64_t>(), checksum = header.number<uint64_t>();
  const std::string_view body = bytes.substr(kHeaderSize);
  if (body.size() != size)
    refuse(name, fmt::format("holds {} bytes where {} were written", body.size(), size), kBakeAgain);
  if (hash_bytes(body.data(), body.size()) != checksum)
    refuse(name, "has been changed: its checksum does not match", kBakeAgain);

  Bake bake;
  Reader reader{ByteReader(body, name), version};
  payload(reader, bake);
  if (reader.in.left() != 0) reader.in.fail("goes on where it should end");
  check(bake, name);
  return bake;
}

void write_bake(const Bake& bake, const std::filesystem::path& path) {
  check(bake, path.string());
  write_file(path, encode_bake(bake));
}

Bake read_bake(const std::filesystem::path& path) {
  constexpr size_t kLargest = size_t{2} << 30;
  return decode_bake(read_file(path, kLargest), path.string());
}

}  // namespace liana
