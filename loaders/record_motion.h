// What moves while the shutter is open: a file posed so often that what is linear from pose to pose stands for all
// times.
#pragma once

#include "loaders/gltf_file.h"

namespace alhazen {

/// Gives a scene, which the file's load() or move() left at the time `open`, its motion during the `shutter` seconds,
/// more than 0, from then on: of instances, shapes, deforming meshes, lights and cameras.
///
/// accuracy  between poses nothing is further from its place than 1/2048 of its size: cameras and lights than of the
/// way
///           that they go, directions than 1/2048 rad. Where that takes more than 128 steps, or poses of more than 1
///           GiB in all, as near as these come.
/// as at the opening  materials, texture coordinates, colours; whether something is shown; meshes whose vertices split
///           otherwise from pose to pose.
void record_motion(GltfFile& file, Scene& scene, double open, double shutter);

}  // namespace alhazen
