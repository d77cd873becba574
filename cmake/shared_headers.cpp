// Compiled for its precompiled header alone (CMakeLists.txt).
