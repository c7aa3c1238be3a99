#include "crosscheck/native_geometry.h"

namespace alhazen::crosscheck {
namespace {

class NativeParty final : public Party {
 public:
  NativeParty(const Subject& subject, bool robust)
      : scene_(robust), surface_(subject.surface), map_(inverse(subject.world_from_object)) {
    RTCGeometry g = new_native_geometry(scene_.device(), surface_);
    if (!g) return;
    exists_ = true;
    if (subject.world_from_object == Affine3d{})
      scene_.attach(g);
    else
      scene_.attach_instance(g, Affine3f(subject.world_from_object), robust);
    scene_.commit();
  }

  [[nodiscard]] bool exists() const { return exists_; }

  void answer(std::span<const Rayf> rays, std::vector<Answer>& answers) override {
    answers.assign(rays.size(), {});
    std::vector<Rayf> asked(rays.begin(), rays.end());
    for (size_t k = 0; k < rays.size(); ++k) {
      answers[k].asked = native_is_for(surface_, map_, rays[k]);
      if (!answers[k].asked) asked[k] = Rayf{{0, 0, 0}, {0, 0, 1}};
    }
    scene_.trace(asked, [&](size_t k, const auto& hit, size_t lane, float t) {
      if (answers[k].asked) answers[k] = native_answer(surface_, hit, lane, t);
    });
  }

 private:
  EmbreeScene scene_;
  const Surface& surface_;
  Affine3d map_;
  bool exists_ = false;
};

}  // namespace

std::unique_ptr<Party> native_party(const Subject& subject, bool robust) {
  auto party = std::make_unique<NativeParty>(subject, robust);
  if (!party->exists()) return nullptr;
  return party;
}

const EmbreeFacts& embree_facts() {
  static const EmbreeFacts facts = [] {
    RTCDevice device = shared_device();
    EmbreeFacts found{RTC_VERSION_STRING, "other", embree::packet_width(device)};
    const auto has = [&](RTCDeviceProperty property) { return rtcGetDeviceProperty(device, property) != 0; };
#if defined __x86_64__ || defined __i386__
    if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED))
      found.isa = "avx512";
    else if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED))
      found.isa = __builtin_cpu_supports("avx2") ? "avx2" : "avx";
    else if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED))
      found.isa = "sse4.2";
#endif
    return found;
  }();
  return facts;
}

}  // namespace alhazen::crosscheck
