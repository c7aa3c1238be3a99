#include "crosscheck/crosscheck.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "accel/shape_hits.h"
#include "core/fork_join.h"
#include "crosscheck/native_subject.h"

namespace alhazen::crosscheck {
namespace {

constexpr uint64_t kRelatedChunks = 8;  // of one chunk in so many, the rays are asked in other ways, too
constexpr size_t kChunksAtOnce = 32;    // bounds the memory

uint64_t hashed(const std::string& text) {
  uint64_t h = 0xcbf29ce484222325u;  // FNV-1a
  for (const char c : text) h = (h ^ uint8_t(c)) * 0x100000001b3u;
  return h;
}

/// Rays [first, end) of one subject.
struct Chunk {
  uint64_t number = 0, first = 0, end = 0;
};

struct ChunkResult {
  Subject subject;
  Tally tally;
  std::vector<Case> cases;
};

void measure_t(const Answer& answer, const Judgement& truth, uint64_t& judged, uint64_t& exact, double& worst) {
  if (!answer.asked || !answer.hit || !truth.hit) return;
  const double off = floats_between(answer.t, truth.t);
  ++judged, exact += off == 0, worst = std::max(worst, off);
}

class ChunkCheck {
 public:
  ChunkCheck(const Family& family, Population population, const Options& options, const Chunk& chunk,
             ChunkResult& result)
      : population_(population), options_(options), chunk_(chunk), result_(result), robust_(family.robust_native) {
    const uint64_t kind = hashed(family.name);
    Random random{options.seed, kind, uint64_t(population), chunk.number, 1};
    result_.subject = family.subject(chunk.number, population == Population::lattice, random);
    const Judge judge(result_.subject);
    make_rays(judge, kind);
    ask();
    const bool relate = chunk.number % kRelatedChunks == 0 && !options.intersector && !options.only;
    if (relate)
      result_.tally.relations = check_relations(result_.subject, rays_, a_, chunk.first,
                                                {options.seed, kind, uint64_t(population), chunk.number, 3});
    for (uint64_t k = 0; k < rays_.size(); ++k)
      if (!options.only || *options.only == chunk.first + k) judge_ray(judge, k);
  }

 private:
  void make_rays(const Judge& judge, uint64_t kind) {
    const RayMaker maker(result_.subject, judge);
    for (uint64_t k = chunk_.first; k < chunk_.end; ++k) {
      Random random{options_.seed, kind, uint64_t(population_), k, 2};
      rays_.push_back(maker.ray(population_, random));
    }
  }

  /// Rays out of the domain are not asked about: Debian's Embree ends the program on some of them.
  void ask() {
    std::vector<Rayf> rays = rays_;
    for (Rayf& ray : rays)
      if (!in_domain(ray)) ray = Rayf{{0, 0, 0}, {0, 0, 1}};
    const DoubtCounts before = doubt_counts();
    (options_.intersector ? plugin_party(*options_.intersector) : custom_party(result_.subject))->answer(rays, a_);
    const DoubtCounts after = doubt_counts();
    result_.tally.a_quads = after.quad - before.quad, result_.tally.a_rationals = after.exact - before.exact;
    const auto native = native_subject(result_.subject);
    if (!native) return;
    if (const auto party = native_party(native->subject, robust_)) party->answer(rays, b_);
    if (native->rounded) native_judge_ = std::make_unique<Judge>(native->subject);
  }

  void judge_ray(const Judge& judge, uint64_t k) {
    Case c{.population = population_,
           .index = chunk_.first + k,
           .subject = &result_.subject,
           .ray = rays_[k],
           .a = a_[k],
           .b = {},
           .truth = {},
           .b_truth = {},
           .b_fault = {},
           .verdict = Verdict::out_of_domain,
           .robust_native = robust_};
    if (!b_.empty() && b_[k].asked) c.b = b_[k];
    if (in_domain(c.ray)) decide(judge, c);
    count(c, result_.tally);
    result_.cases.push_back(std::move(c));
  }

  void decide(const Judge& judge, Case& c) const {
    c.truth = judge.closest(c.ray);
    if (c.truth.hit && !std::isfinite(c.truth.t)) return;  // further than floats reach
    c.a_fault = fault_of(c.a, c.truth, options_.t_tolerance_a);
    if (c.b && native_judge_) c.b_truth = native_judge_->closest(c.ray);
    if (c.b) c.b_fault = fault_of(*c.b, truth_for_b(c), options_.t_tolerance_b);
    c.verdict = verdict_of(c.a_fault, c.b_fault, c.truth);
    if (c.index % kSecondInstance == 0 && !same_answer(c.truth, judge.closest_exactly(c.ray)))
      c.verdict = Verdict::unexplained;
  }

  Population population_;
  const Options& options_;
  Chunk chunk_;
  ChunkResult& result_;
  bool robust_;
  std::vector<Rayf> rays_;
  std::vector<Answer> a_, b_;
  std::unique_ptr<Judge> native_judge_;  // where B holds another surface
};

std::vector<Chunk> chunks_of(const Family& family, const Options& options) {
  std::vector<Chunk> chunks;
  const uint64_t size = family.chunk_rays;
  if (options.only) return {{*options.only / size, *options.only / size * size, (*options.only / size + 1) * size}};
  for (uint64_t first = 0; first < options.rays; first += size)
    chunks.push_back({first / size, first, std::min(first + size, options.rays)});
  return chunks;
}

}  // namespace

uint64_t Tally::failures() const {
  uint64_t broken = 0;
  for (const RelationCount& relation : relations) broken += relation.broken;
  return of(Verdict::b_right) + of(Verdict::both_wrong) + of(Verdict::unexplained) + broken;
}

void count(const Case& c, Tally& tally) {
  ++tally.rays, ++tally.verdicts[size_t(c.verdict)];
  tally.hits += c.truth.hit, tally.judge_rationals += c.truth.by == JudgedBy::rationals;
  ++tally.a_faults[size_t(c.a_fault)];
  measure_t(c.a, c.truth, tally.a_judged, tally.a_exact, tally.a_worst);
  if (!c.b_fault) return;
  ++tally.b_asked, ++tally.b_faults[size_t(*c.b_fault)];
  measure_t(*c.b, truth_for_b(c), tally.b_judged, tally.b_exact, tally.b_worst);
}

void Tally::add(const Tally& o) {
  const auto sum = [](auto& mine, const auto& theirs) {
    for (size_t k = 0; k < mine.size(); ++k) mine[k] += theirs[k];
  };
  rays += o.rays, hits += o.hits, b_asked += o.b_asked;
  sum(verdicts, o.verdicts), sum(a_faults, o.a_faults), sum(b_faults, o.b_faults);
  a_judged += o.a_judged, a_exact += o.a_exact, b_judged += o.b_judged, b_exact += o.b_exact;
  a_worst = std::max(a_worst, o.a_worst), b_worst = std::max(b_worst, o.b_worst);
  for (size_t k = 0; k < relations.size(); ++k) relations[k].add(o.relations[k]);
  a_quads += o.a_quads, a_rationals += o.a_rationals, judge_rationals += o.judge_rationals;
}

Tally check(const Family& family, Population population, const Options& options, const Observer& observer) {
  Tally tally;
  const std::vector<Chunk> chunks = chunks_of(family, options);
  for (size_t first = 0; first < chunks.size() && !observer.stop(); first += kChunksAtOnce) {
    const size_t count = std::min(kChunksAtOnce, chunks.size() - first);
    std::vector<ChunkResult> results(count);
    {
      const ForkJoin order;
      tbb::parallel_for(size_t(0), count, order.task([&](size_t k) {
        ChunkCheck(family, population, options, chunks[first + k], results[k]);
      }));
    }
    for (const ChunkResult& result : results) {
      tally.add(result.tally);
      if (observer.judged)
        for (const Case& c : result.cases) observer.judged(c);
    }
  }
  return tally;
}

}  // namespace alhazen::crosscheck
