// parse_obj on any bytes: triangles with valid corners, or an Error.
#include "mesher/base/error.h"
#include "mesher/io/triangle_soup.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  try {
    const liana::TriangleSoup soup =
        liana::parse_obj({reinterpret_cast<const char*>(data), size}, "fuzz.obj");
    liana::require(soup.label.size() == soup.triangles.size(), "a label per triangle");
    for (const liana::Triangle& t : soup.triangles)
      for (const uint32_t v : t) liana::require(v < soup.positions.size(), "valid corners");
  } catch (const liana::Error&) {
  }
  return 0;
}
