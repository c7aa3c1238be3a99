#include "crosscheck/scene_check.h"

#include <tbb/parallel_for.h>

#include <deque>

#include "accel/accelerated_scene.h"
#include "accel/shape_hits.h"
#include "core/fork_join.h"
#include "crosscheck/scene_judge.h"
#include "crosscheck/triangle_scene.h"
#include "renderer/camera_cell.h"

namespace alhazen::crosscheck {
namespace {

constexpr size_t kCellsAtOnce = 32;  // bounds the memory

Geometry shapes_of(const Geometry& geometry) {
  Geometry shapes;
  shapes.shapes = geometry.shapes, shapes.shape_instances = geometry.shape_instances;
  return shapes;
}

/// A hierarchy of the meshes alone, which it reads in place.
std::unique_ptr<AcceleratedScene> mesh_scene(Geometry& geometry) {
  auto shapes = std::exchange(geometry.shape_instances, {});
  auto scene = std::make_unique<AcceleratedScene>(geometry, SurfaceFilter{});
  geometry.shape_instances = std::move(shapes);  // their objects come after those of meshes
  return scene;
}

struct CellResult {
  Tally tally;
  PictureTally picture;
  std::vector<Case> cases;
  std::deque<Subject> subjects;  // of the cases
};

/// The first thing that is wrong, `wrong_surface` after all else.
Fault fault_in_scene(const SceneAnswer& said, const SceneTruth& truth, double t_tolerance) {
  Answer answer = said.answer;
  if (answer.hit && said.id != truth.first()) answer.face = kNoFace, answer.normal_object = {};
  const Fault fault = fault_of(answer, truth.nearest, t_tolerance);
  const bool elsewhere = fault == Fault::none && answer.hit && !is_first(truth, said.id, t_tolerance);
  return elsewhere ? Fault::wrong_surface : fault;
}

void add(const PictureTally& from, PictureTally& to) {
  to.pixels += from.pixels, to.other_surface += from.other_surface;
  to.worst_t = std::max(to.worst_t, from.worst_t);
  if (!to.example) to.example = from.example;
}

}  // namespace

struct SceneCheck::Impl {
  const Geometry& geometry;
  Geometry shapes;
  std::vector<std::string> node_names;
  SceneBoxes boxes;
  AcceleratedScene shape_scene;
  std::unique_ptr<AcceleratedScene> meshes;
  NativeScene native;
  SceneJudge judge;
  std::optional<SceneJudge> native_judge;  // where B's scene is another one

  Impl(Geometry& whole, std::span<const std::string> names)
      : geometry(whole),
        shapes(shapes_of(geometry)),
        node_names(names.begin(), names.end()),
        boxes(geometry),
        shape_scene(shapes, {}),
        meshes(mesh_scene(whole)),
        native(boxes),
        judge(boxes) {
    if (native.is_rounded() || !shapes.shape_instances.empty()) native_judge.emplace(boxes, &native);
  }

  /// What a hierarchy over meshes or shapes alone hits; its objects are numbered from `first_object` on.
  static void trace(const AcceleratedScene& scene, const RayWave& wave, uint32_t first_object,
                    std::vector<SceneAnswer>& answers) {
    HitWave hits;
    scene.intersect(wave, Coherence::coherent, hits);
    answers.assign(wave.size(), {});
    for (size_t k = 0; k < wave.size(); ++k) {
      if (hits.object[k] == kNone) continue;
      answers[k].answer.hit = true, answers[k].answer.t = hits.t[k];
      answers[k].id = {hits.object[k] + first_object, hits.part[k], hits.primitive[k]};
      answers[k].answer.native = {{}, true, hits.u[k], hits.v[k]};
    }
  }

  void trace_shapes(const RayWave& wave, std::vector<SceneAnswer>& answers) const {
    trace(shape_scene, wave, uint32_t(geometry.mesh_instances.size()), answers);
    for (size_t k = 0; k < wave.size(); ++k) {
      if (!answers[k].answer.hit) continue;
      const ShapeInstance& placed = shape_instance(geometry, answers[k].id.object);
      Answer& answer = answers[k].answer;
      answer.native.reset();  // it has no barycentric weights
      answer.face = int(std::exchange(answers[k].id.part, 0));
      answer.normal_object =
          normal_at_hit(geometry.shapes[placed.shape], placed.world_from_object, wave.get(k), answer.t, answer.face);
    }
  }

  void trace_meshes(const RayWave& wave, std::vector<SceneAnswer>& answers) const { trace(*meshes, wave, 0, answers); }

  /// The watertight triangle, on every triangle whose box the ray passes.
  [[nodiscard]] SceneAnswer closest_triangle(const Rayf& ray) const {
    SceneAnswer nearest;
    double t_limit = double(ray.t_max);
    boxes.visit(ray, t_limit, [&](const SurfaceId& id, const Triangle* triangle, const ObjectLine<double>&) {
      if (!triangle) return;
      const auto t = hit_triangle(*triangle, ray, geometry.mesh_instances.world_from_object(id.object));
      if (!t || (nearest.answer.hit && !(*t < nearest.answer.t))) return;
      nearest.answer.hit = true, nearest.answer.t = *t, nearest.id = id, t_limit = double(*t);
      nearest.answer.normal_object = normal(*triangle, {}, 0);
    });
    return nearest;
  }

  [[nodiscard]] double facing(const SceneTruth& truth, const Rayf& ray) const {
    if (!truth.nearest.hit) return 0;
    const Affine3d& m = boxes.world_from_object(truth.first().object);
    const Vec3d n_world = normalize(transform_normal(m, truth.nearest.normal_object));
    return std::abs(dot(n_world, normalize(Vec3d(ray.direction))));
  }

  [[nodiscard]] std::string label(const SurfaceId& id) const {
    std::string text = node_label(node_names, node_of(geometry, id.object));
    if (is_shape(geometry, id.object)) return text;
    return text + ", triangle " + std::to_string(id.triangle) + " of primitive " + std::to_string(id.part);
  }
};

namespace {

/// The rays of one cell.
class CellCheck {
 public:
  CellCheck(const SceneCheck::Impl& scene, const View& view, const Cell& cell, const Options& options,
            CellResult& result)
      : scene_(scene), options_(options), result_(result) {
    for_each_pixel(cell, [&](int x, int y) {
      pixels_.push_back(uint64_t(y) * uint64_t(view.width) + uint64_t(x)), rays_.push_back(view.ray(x, y));
    });
    ask();
    for (size_t k = 0; k < rays_.size(); ++k)
      if (!options.only || *options.only == pixels_[k]) judge_ray(k);
  }

 private:
  void ask() {
    asked_ = rays_;
    RayWave wave;
    wave.resize(rays_.size());
    for (size_t k = 0; k < rays_.size(); ++k) {
      if (!in_domain(rays_[k])) asked_[k] = Rayf{{0, 0, 0}, {0, 0, 1}};
      wave.set(k, asked_[k]);
    }
    const DoubtCounts before = doubt_counts();
    scene_.trace_shapes(wave, shapes_);
    for (const Rayf& ray : asked_) triangles_.push_back(scene_.closest_triangle(ray));
    const DoubtCounts after = doubt_counts();
    result_.tally.a_quads = after.quad - before.quad, result_.tally.a_rationals = after.exact - before.exact;
    scene_.native.answer(asked_, native_shapes_);
    scene_.trace_meshes(wave, native_triangles_);
  }

  void judge_ray(size_t k) {
    Case c{};
    c.population = Population::camera, c.index = pixels_[k], c.ray = rays_[k], c.robust_native = true;
    c.verdict = Verdict::out_of_domain;
    if (in_domain(c.ray)) decide(k, c);
    count(c, result_.tally);
    result_.cases.push_back(std::move(c));
  }

  void decide(size_t k, Case& c) {
    const SceneTruth truth = scene_.judge.closest(c.ray);
    const SceneAnswer &a = nearer(shapes_[k], triangles_[k]), &b = nearer(native_shapes_[k], native_triangles_[k]);
    c.a = a.answer, c.truth = truth.nearest, c.object = truth.first().object, c.facing = scene_.facing(truth, c.ray);
    if (c.truth.hit && !std::isfinite(c.truth.t)) return;  // further than floats reach
    c.a_fault = fault_in_scene(a, truth, options_.t_tolerance_a);
    ask_second_opinion(b, truth, c);
    c.verdict = verdict_of(c.a_fault, c.b_fault, c.truth);
    if (c.index % kSecondInstance == 0 && c.truth.hit &&
        !same_answer(c.truth, Judge(scene_.boxes.subject(truth.first())).closest_exactly(c.ray)))
      c.verdict = Verdict::unexplained;
    compare_picture(nearer(shapes_[k], native_triangles_[k]), truth, c.index);
    const bool agreed = c.verdict == Verdict::agree && c.b_fault.value_or(Fault::none) == Fault::none;
    if (!agreed || options_.only) describe(a, b, truth, c);
  }

  /// Only where B holds everything that the ray may meet first.
  void ask_second_opinion(const SceneAnswer& b, const SceneTruth& truth, Case& c) const {
    const SceneTruth own = scene_.native_judge ? scene_.native_judge->closest(c.ray) : truth;
    if (!own.complete) return;
    c.b = b.answer, c.b_fault = fault_in_scene(b, own, options_.t_tolerance_b);
    if (!same_answer(own.nearest, truth.nearest)) c.b_truth = own.nearest;
  }

  void compare_picture(const SceneAnswer& shown, const SceneTruth& truth, uint64_t pixel) {
    PictureTally& tally = result_.picture;
    ++tally.pixels;
    const bool right =
        shown.answer.hit == truth.nearest.hit && (!shown.answer.hit || is_first(truth, shown.id, kTiedFloats));
    if (right && shown.answer.hit)
      tally.worst_t = std::max(tally.worst_t, floats_between(shown.answer.t, truth.nearest.t));
    if (right) return;
    ++tally.other_surface;
    if (!tally.example) tally.example = pixel;
  }

  void describe(const SceneAnswer& a, const SceneAnswer& b, const SceneTruth& truth, Case& c) {
    const auto label = [&](bool hit, const SurfaceId& id) { return hit ? scene_.label(id) : std::string(); };
    c.a_surface = label(a.answer.hit, a.id), c.true_surface = label(truth.nearest.hit, truth.first());
    if (c.b) c.b_surface = label(b.answer.hit, b.id);
    const SurfaceId id = truth.nearest.hit ? truth.first() : a.answer.hit ? a.id : b.id;
    if (id.object == kNone) return;
    result_.subjects.push_back(scene_.boxes.subject(id));
    result_.subjects.back().origin = scene_.label(id);
    c.subject = &result_.subjects.back();
  }

  const SceneCheck::Impl& scene_;
  const Options& options_;
  CellResult& result_;
  std::vector<uint64_t> pixels_;
  std::vector<Rayf> rays_, asked_;
  std::vector<SceneAnswer> shapes_, triangles_, native_shapes_, native_triangles_;
};

/// Those of the picture, or of one pixel.
std::vector<Cell> cells_of(const View& view, const Options& options) {
  std::vector<Cell> cells;
  for (int y = 0; y < view.height; y += kCellSize)
    for (int x = 0; x < view.width; x += kCellSize)
      cells.push_back({x, y, std::min(x + kCellSize, view.width), std::min(y + kCellSize, view.height)});
  if (!options.only) return cells;
  const auto x = int(*options.only % uint64_t(view.width)), y = int(*options.only / uint64_t(view.width));
  std::erase_if(cells, [&](const Cell& c) { return x < c.x0 || x >= c.x1 || y < c.y0 || y >= c.y1; });
  return cells;
}

}  // namespace

SceneCheck::SceneCheck(Geometry& geometry, std::span<const std::string> node_names)
    : impl_(std::make_unique<const Impl>(geometry, node_names)) {}
SceneCheck::~SceneCheck() = default;

Tally SceneCheck::check(const View& view, const Options& options, const Observer& observer,
                        PictureTally& picture) const {
  Tally tally;
  const std::vector<Cell> cells = cells_of(view, options);
  for (size_t first = 0; first < cells.size() && !observer.stop(); first += kCellsAtOnce) {
    const size_t count = std::min(kCellsAtOnce, cells.size() - first);
    std::vector<CellResult> results(count);
    {
      const ForkJoin order;
      tbb::parallel_for(size_t(0), count,
                        order.task([&](size_t k) { CellCheck(*impl_, view, cells[first + k], options, results[k]); }));
    }
    for (const CellResult& result : results) {
      tally.add(result.tally), add(result.picture, picture);
      if (observer.judged)
        for (const Case& c : result.cases) observer.judged(c);
    }
  }
  return tally;
}

}  // namespace alhazen::crosscheck
