// read_gltf_plant on any bytes; buffers beside the file are not there.
#include "mesher/base/error.h"
#include "mesher/io/plant_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  for (const bool merged : {false, true}) try {
      const liana::GltfPlant plant = liana::read_gltf_plant(bytes, "/nowhere/fuzz.glb", 1, merged);
      liana::require(plant.segmented != plant.plant.domains.empty(), "segmented or not");
      liana::require(plant.soup.label.size() == plant.soup.triangles.size(), "a label per triangle");
    } catch (const liana::Error&) {
    }
  return 0;
}
