// The editor in a window.
#pragma once

#include "runtime/view/editor_core.h"

namespace liana {

/// Opens a window on the simulation and returns the exit code (0) once the user closes it.
/// Throws Error{Usage} without a display, Error{Output} without OpenGL 3.3.
int run_editor(Simulation& simulation, const EditorOptions& options);

}  // namespace liana
