#include "crosscheck/crosscheck.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/fork_join.h"
#include "crosscheck/subject_check.h"

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

void check_chunk(const Family& family, Population population, const Options& options, const Chunk& chunk,
                 ChunkResult& result) {
  const uint64_t kind = hashed(family.name);
  Random random{options.seed, kind, uint64_t(population), chunk.number, 1};
  result.subject = family.subject(chunk.number, population == Population::lattice, random);
  SubjectCheck check(result.subject, family.robust_native, options);
  const RayMaker maker(result.subject, check.judge());
  std::vector<Rayf> rays;
  for (uint64_t k = chunk.first; k < chunk.end; ++k) {
    Random of_ray{options.seed, kind, uint64_t(population), k, 2};
    rays.push_back(maker.ray(population, of_ray));
  }
  check.ask(rays, result.tally);
  if (chunk.number % kRelatedChunks == 0 && !options.intersector && !options.only)
    result.tally.relations = check_relations(result.subject, rays, check.answers(), chunk.first,
                                             {options.seed, kind, uint64_t(population), chunk.number, 3});
  for (uint64_t k = 0; k < rays.size(); ++k) {
    if (options.only && *options.only != chunk.first + k) continue;
    result.cases.push_back(check.judged(k, population, chunk.first + k));
    const Case& c = result.cases.back();
    count(c, result.tally);
    if (c.verdict != Verdict::out_of_domain)
      count_textbook(result.subject, c.ray, c.truth, options.t_tolerance_a, result.tally.textbook);
  }
}

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
  for (size_t k = 0; k < textbook.size(); ++k) textbook[k].add(o.textbook[k]);
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
        check_chunk(family, population, options, chunks[first + k], results[k]);
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
