// All of a world's state as one value: what a snapshot holds.
#pragma once

#include <cstdint>
#include <span>

#include "mesher/base/archive.h"

namespace liana {

struct Scene;
class Garden;

/// Bytes with a head: what they are, version, which scene they are of, checksum. Two are equal exactly when
/// their worlds will go on alike. Keep one to save into again: its memory is used again.
class WorldState {
 public:
  WorldState() = default;
  /// Of bytes(), kept somewhere in between. Throws Error{Input} for bytes that are damaged, cut short, of
  /// another version, or no state.
  explicit WorldState(std::span<const std::byte> bytes);

  bool empty() const { return bytes_.size() == 0; }
  std::span<const std::byte> bytes() const { return bytes_.view(); }
  uint64_t scene() const;  ///< identity_of() its scene
  uint64_t hash() const;   ///< the same for the same state of the same scene
  friend bool operator==(const WorldState& a, const WorldState& b) { return a.bytes_ == b.bytes_; }

  /// Replaces it by what persist(StateWriter&) writes.
  template <class Persist>
  void write(uint64_t scene, const Persist& persist) {
    begin(scene);
    StateWriter writer(bytes_);
    persist(writer);
    finish();
  }
  /// Calls persist(StateReader&). Throws Error{Input}, before it does so, when the state is of another scene.
  template <class Persist>
  void read(uint64_t scene, const Persist& persist) const {
    check_scene(scene);
    StateReader reader(payload());
    persist(reader);
    reader.finish();
  }

 private:
  void begin(uint64_t scene);
  void finish();
  void check_scene(uint64_t scene) const;
  std::span<const std::byte> payload() const;

  StateBytes bytes_;
};

/// One number for what a scene is and for the files its plants come from.
uint64_t identity_of(const Scene& scene, const Garden& garden);

}  // namespace liana
