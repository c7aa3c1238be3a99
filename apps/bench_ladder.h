// The ladder of accelerators: what each step from brute force to Embree buys.
#pragma once

#include <string>

namespace alhazen {

/// Prints a row for each accelerator, simplest first, on one thread: the cost of a scene's camera rays.
/// @throw LoadError  as `load_gltf`
void print_ladder(const std::string& file, int width, int height);

}  // namespace alhazen
