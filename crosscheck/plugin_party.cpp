#include <cmath>

#include "crosscheck/embree_scene.h"
#include "crosscheck/party.h"

namespace alhazen::crosscheck {
namespace {

/// What the geometry's callbacks read and write.
struct Shared {
  const Intersector* intersector;
  std::vector<alhazen_hit>* hits;  // by ray
};

void write_bounds(const RTCBoundsFunctionArguments* args) {
  float lower[3], upper[3];
  static_cast<const Shared*>(args->geometryUserPtr)->intersector->bounds(lower, upper);
  *args->bounds_o = {lower[0], lower[1], lower[2], 0, upper[0], upper[1], upper[2], 0};
}

alhazen_ray ray_of(const RTCIntersectFunctionNArguments* args, unsigned i) {
  RTCRayN* ray = RTCRayHitN_RayN(args->rayhit, args->N);
  const unsigned n = args->N;
  return {{RTCRayN_org_x(ray, n, i), RTCRayN_org_y(ray, n, i), RTCRayN_org_z(ray, n, i)},
          {RTCRayN_dir_x(ray, n, i), RTCRayN_dir_y(ray, n, i), RTCRayN_dir_z(ray, n, i)},
          RTCRayN_tnear(ray, n, i),
          RTCRayN_tfar(ray, n, i)};
}

void intersect(const RTCIntersectFunctionNArguments* args) {
  const Shared& shared = *static_cast<const Shared*>(args->geometryUserPtr);
  alhazen_ray rays[16];
  alhazen_hit hits[16] = {};
  int found[16] = {};
  unsigned lanes[16];
  int count = 0;
  for (unsigned i = 0; i < args->N; ++i)
    if (args->valid[i]) embree::reject(args, i), rays[count] = ray_of(args, i), lanes[count++] = i;
  shared.intersector->intersect_packet(rays, count, hits, found);
  for (int k = 0; k < count; ++k) {
    if (!found[k]) continue;
    embree::accept(args, lanes[k], hits[k].t);
    (*shared.hits)[RTCRayN_id(RTCRayHitN_RayN(args->rayhit, args->N), args->N, lanes[k])] = hits[k];
  }
}

class PluginParty final : public Party {
 public:
  explicit PluginParty(const Intersector& intersector) : shared_{&intersector, &hits_} {
    RTCGeometry g = embree::new_geometry(scene_.device(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(g, 1);
    rtcSetGeometryUserData(g, &shared_);
    rtcSetGeometryBoundsFunction(g, write_bounds, nullptr);
    rtcSetGeometryIntersectFunction(g, intersect);
    scene_.attach(g);
    scene_.commit();
  }

  void answer(std::span<const Rayf> rays, std::vector<Answer>& answers) override {
    hits_.assign(rays.size(), {});
    answers.assign(rays.size(), {});
    scene_.trace(rays, [&](size_t k, const auto&, size_t, float) {
      const alhazen_hit& hit = hits_[k];
      const Vec3d n{hit.normal[0], hit.normal[1], hit.normal[2]};
      answers[k] = {.hit = true,
                    .t = hit.t,
                    .face = hit.face == ALHAZEN_NO_FACE ? kNoFace : int(hit.face),
                    .normal_object = normalize(n)};
    });
  }

 private:
  EmbreeScene scene_{true};
  std::vector<alhazen_hit> hits_;
  Shared shared_;
};

}  // namespace

std::unique_ptr<Party> plugin_party(const Intersector& intersector) {
  return std::make_unique<PluginParty>(intersector);
}

}  // namespace alhazen::crosscheck
