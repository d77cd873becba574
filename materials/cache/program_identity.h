// Which program this is: results of another one may differ.
#pragma once

#include <cstdint>

namespace liana {

/// Hash of the running program and of the libraries it has loaded: their contents for the program itself,
/// path, size and time of the libraries.
uint64_t program_identity();

}  // namespace liana
