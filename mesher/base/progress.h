// Long work reports its stage and how far it is, and asks whether to stop.
#pragma once

#include <cstddef>
#include <string_view>

#include "mesher/base/error.h"

namespace liana {

/// Thread-safe in implementations: advance() is called from worker threads. The base class is silent.
class Progress {
 public:
  virtual ~Progress() = default;
  virtual void begin(std::string_view stage, size_t total) { (void)stage, (void)total; }
  virtual void advance(size_t count = 1) { (void)count; }
  virtual bool cancelled() const { return false; }

  void throw_if_cancelled() const {
    if (cancelled()) throw Error(Error::Kind::Cancelled, "cancelled");
  }
};

}  // namespace liana
