// Files that are written completely or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>

namespace alhazen {

/// A new file beside its target that takes the target's place when it is committed, and vanishes otherwise: the target
/// is what it was, or complete, whenever the program or the machine stops. A symbolic link stays one; what it points to
/// is replaced. One at a time in a process.
class PartFile {
 public:
  /// Throws WriteError where the target's folder takes no new file, or the target is no regular file or protected.
  explicit PartFile(const std::filesystem::path& target);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  /// Where it lies until it is committed; has the target's extension.
  [[nodiscard]] const std::filesystem::path& path() const { return part_; }

  /// Appends; throws WriteError.
  void write(std::span<const uint8_t> bytes);

  /// Flushes to the disk and renames; throws WriteError.
  void commit();

 private:
  std::filesystem::path named_, target_, part_;
  int fd_ = -1;
};

/// Calls `write` with a part that is committed when it returns. What it throws becomes a WriteError, unless it is an
/// Error or std::bad_alloc.
void write_whole(const std::filesystem::path& file, const std::function<void(PartFile& part)>& write);

/// Removes the PartFile that there is. Async-signal-safe: for a handler about to end the process.
void remove_part_file() noexcept;

}  // namespace alhazen
