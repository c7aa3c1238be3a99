#include "apps/progress.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stop_token>
#include <string_view>
#include <thread>
#include <utility>

namespace alhazen {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kEraseLine = "\r\033[K";
constexpr double kLoadingWorthMention = 1;  // seconds

template <class... T>
std::string format(const char* pattern, T... values) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

/// Writes if that can be done without waiting: what a slow reader misses is followed by a newer report.
void offer(int fd, const std::string& text) {
  pollfd ready{fd, POLLOUT, 0};
  if (poll(&ready, 1, 0) == 1 && (ready.revents & POLLOUT)) (void)!::write(fd, text.data(), text.size());
}

Progress progress_of(const RenderControl& control, uint64_t pixels, double seconds) {
  return {control.tiles_done, control.tiles, double(control.pixels_done) / double(pixels), ray_counts(control).all(),
          seconds};
}

size_t terminal_columns() {
  winsize size = {};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col : 80;
}

}  // namespace

ProgressStyle resolve(ProgressStyle style) {
  if (style != ProgressStyle::automatic) return style;
  const char* terminal = std::getenv("TERM");
  const bool renewable = isatty(STDERR_FILENO) && terminal && std::string_view(terminal) != "dumb";
  return renewable ? ProgressStyle::renewed : ProgressStyle::plain;
}

RayCounts ray_counts(const RenderControl& control) {
  return {control.camera_rays, control.mirror_rays, control.refracted_rays, control.shadow_rays};
}

std::string duration_text(double seconds) {
  if (seconds < 59.95) return format("%.1f s", std::max(0.0, seconds));
  const auto s = uint64_t(std::llround(std::min(seconds, 1e15)));
  const auto number = [](uint64_t v) { return static_cast<unsigned long long>(v); };
  if (s < 3600) return format("%llu:%02llu", number(s / 60), number(s % 60));
  return format("%llu:%02llu:%02llu", number(s / 3600), number(s / 60 % 60), number(s % 60));
}

std::string progress_text(const std::string& title, const Progress& p) {
  const std::string left = p.seconds_left() < 0 ? "" : "  " + duration_text(p.seconds_left()) + " left";
  return title + format("  [%u/%u tiles %3.0f%%]", p.tiles, p.all_tiles, std::floor(100 * p.fraction)) +
         format("  %.1f Mray/s  ", 1e-6 * p.rays_per_second()) + duration_text(p.seconds) + " elapsed" + left;
}

std::string progress_json(const Progress& p) {
  nlohmann::ordered_json json;
  json["event"] = "progress";
  json["tiles"] = p.tiles;
  json["tiles_total"] = p.all_tiles;
  json["fraction"] = p.fraction;
  json["rays"] = p.rays;
  json["rays_per_second"] = p.rays_per_second();
  json["seconds"] = p.seconds;
  json["seconds_left"] = p.seconds_left() < 0 ? nlohmann::ordered_json() : nlohmann::ordered_json(p.seconds_left());
  return json.dump();
}

std::string progress_text(const std::string& title, const LoadProgress& p, double seconds) {
  const uint64_t done = p.done, all = p.all;
  const std::string count = all > 0 ? " " + std::to_string(std::min(done, all)) + "/" + std::to_string(all) : "";
  return title + "  " + p.phase.load() + count + "  " + duration_text(seconds) + " elapsed";
}

std::string progress_json(const LoadProgress& p, double seconds) {
  nlohmann::ordered_json json;
  json["event"] = "loading";
  json["phase"] = p.phase.load();
  json["done"] = p.done.load();
  json["all"] = p.all.load();
  json["seconds"] = seconds;
  return json.dump();
}

double report_interval(ProgressStyle style, double elapsed) {
  if (style == ProgressStyle::plain) return std::clamp(elapsed / 10, 10.0, 600.0);
  return std::clamp(elapsed / 20, 0.2, 5.0);
}

struct ProgressReporter::Impl {
  using Say = std::function<std::string(double seconds)>;

  ProgressStyle style;
  double first_after;  // seconds
  Say say_text, say_json;
  Clock::time_point start = Clock::now();
  std::jthread thread{};

  [[nodiscard]] double elapsed() const { return std::chrono::duration<double>(Clock::now() - start).count(); }

  void report() const {
    if (style == ProgressStyle::json) return offer(STDOUT_FILENO, say_json(elapsed()) + "\n");
    const std::string text = say_text(elapsed());
    if (style == ProgressStyle::plain) return offer(STDERR_FILENO, text + "\n");
    offer(STDERR_FILENO, kEraseLine + text.substr(0, terminal_columns() - 1));
  }

  void run(const std::stop_token& stop) const {
    std::mutex mutex;
    std::condition_variable_any wake;
    std::unique_lock lock(mutex);
    const auto wait = [&] {
      const double wanted = report_interval(style, elapsed());
      const std::chrono::duration<double> interval(elapsed() < first_after ? std::max(wanted, first_after) : wanted);
      wake.wait_for(lock, stop, interval, [] { return false; });
      return !stop.stop_requested();
    };
    bool has_reported = false;
    for (; wait(); has_reported = true) report();
    if (has_reported && style == ProgressStyle::renewed) offer(STDERR_FILENO, kEraseLine);
  }
};

ProgressReporter::ProgressReporter(ProgressStyle style, std::string title, uint64_t pixels,
                                   const RenderControl& control)
    : ProgressReporter(
          new Impl{resolve(style), 0,
                   [=, &control, title = std::move(title)](double seconds) {
                     return progress_text(title, progress_of(control, pixels, seconds));
                   },
                   [=, &control](double seconds) { return progress_json(progress_of(control, pixels, seconds)); }}) {}

ProgressReporter::ProgressReporter(ProgressStyle style, std::string title, const LoadProgress& progress)
    : ProgressReporter(new Impl{
          resolve(style), kLoadingWorthMention,
          [&progress, title = std::move(title)](double seconds) { return progress_text(title, progress, seconds); },
          [&progress](double seconds) { return progress_json(progress, seconds); }}) {}

ProgressReporter::ProgressReporter(Impl* impl) : impl_(impl) {
  if (impl_->style == ProgressStyle::none) return;
  impl_->thread = std::jthread([impl](const std::stop_token& stop) { impl->run(stop); });
}

ProgressReporter::~ProgressReporter() = default;

}  // namespace alhazen
