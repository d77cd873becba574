#include "runtime/world/world_state.h"

#include <cstddef>

#include "mesher/base/hash.h"
#include "runtime/world/garden.h"

namespace liana {
namespace {

constexpr std::array<char, 8> kMagic = {'l', 'i', 'a', 'n', 'a', 'w', 's', '\n'};
constexpr uint32_t kVersion = 1;

struct Head {
  std::array<char, 8> magic = kMagic;
  uint32_t version = kVersion, reserved = 0;
  uint64_t scene = 0;     // identity_of()
  uint64_t size = 0;      // bytes behind the head
  uint64_t checksum = 0;  // XXH3 of these, from `scene` on
};
static_assert(sizeof(Head) == 40 && std::has_unique_object_representations_v<Head>);

Head head_of(const StateBytes& bytes) {
  Head head;
  require(bytes.size() >= sizeof head, "a world's state that was never saved");
  std::memcpy(&head, bytes.data(), sizeof head);
  return head;
}

}  // namespace

WorldState::WorldState(std::span<const std::byte> bytes) : bytes_(bytes) {
  Head head;
  if (bytes.size() < sizeof head) state_mismatch();
  std::memcpy(&head, bytes.data(), sizeof head);
  if (head.magic != kMagic) throw Error(Error::Kind::Input, "these bytes are not the state of a world");
  if (head.version != kVersion)
    throw Error(Error::Kind::Input, "the saved state is of another version of liana",
                "save it again with this one");
  const bool whole = head.reserved == 0 && head.size == payload().size() &&
                     head.checksum == hash_bytes(payload().data(), payload().size(), head.scene);
  if (!whole) state_mismatch();
}

uint64_t WorldState::scene() const {
  return head_of(bytes_).scene;
}

uint64_t WorldState::hash() const {
  return head_of(bytes_).checksum;
}

std::span<const std::byte> WorldState::payload() const {
  return bytes_.view().subspan(sizeof(Head));
}

void WorldState::begin(uint64_t scene) {
  Head head;
  head.scene = scene;
  bytes_.clear();
  bytes_.append(&head, sizeof head);
}

void WorldState::finish() {
  Head head = head_of(bytes_);
  head.size = payload().size();
  head.checksum = hash_bytes(payload().data(), payload().size(), head.scene);
  std::memcpy(bytes_.data(), &head, sizeof head);
}

void WorldState::check_scene(uint64_t scene) const {
  if (head_of(bytes_).scene != scene)
    throw Error(Error::Kind::Input, "the saved state is of another scene",
                "the scene, its bakes and species must be as they were when it was saved");
}

uint64_t identity_of(const Scene& scene, const Garden& garden) {
  StateHasher hasher;
  hasher(const_cast<Scene&>(scene));  // it only reads
  for (size_t i = 0; i < garden.size(); ++i) {
    uint64_t source = garden.origin_of(garden[i]).source;
    hasher(source);
  }
  return hasher.hash();
}

}  // namespace liana
