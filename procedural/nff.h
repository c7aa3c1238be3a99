// What a scene in Haines' Neutral File Format holds. In space it is as its file says: any axis may be up.
// source  E. Haines, "A Proposal for Standard Graphics Environments", IEEE Computer Graphics and Applications 7(11),
//         1987, and the format's description that comes with its databases.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace alhazen {

/// `f`: color x kd diffuse, ks in highlights and mirror rays, t in refracted rays.
struct NffMaterial {
  Rgb color{1.0f};
  float kd = 1, ks = 0, shine = 0, t = 0, ior = 1;
  friend bool operator==(const NffMaterial&, const NffMaterial&) = default;
};

struct NffLight {
  Vec3d p;
  Rgb color{1.0f};
  bool has_color = false;  // else all lights together have an intensity of sqrt(their number)
};

struct NffSphere {
  Vec3d center;
  double radius = 1;
  uint32_t material = 0;
};

/// The wall of a cone, frustum or cylinder; open.
struct NffCone {
  Vec3d base, apex;
  double base_radius = 1, apex_radius = 0;
  uint32_t material = 0;
};

struct NffPolygon {
  std::vector<Vec3d> vertices;
  std::vector<Vec3d> normals;  // one for each vertex, or none: flat
  uint32_t material = 0;
};

struct NffView {
  Vec3d from{0, 0, 1}, at, up{0, 1, 0};
  double angle = 45;  // degrees, from the bottom of the picture to its top
  int width = 512, height = 512;
};

struct NffScene {
  NffView view;
  Rgb background{0.0f};
  std::vector<NffLight> lights;
  std::vector<NffMaterial> materials;
  std::vector<NffSphere> spheres;
  std::vector<NffCone> cones;
  std::vector<NffPolygon> polygons;

  /// The material's number for what is added next.
  uint32_t add(const NffMaterial& material) {
    materials.push_back(material);
    return uint32_t(materials.size() - 1);
  }
};

}  // namespace alhazen
