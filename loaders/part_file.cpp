#include "loaders/part_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <climits>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <utility>

#include "core/error.h"

namespace alhazen {
namespace {

namespace fs = std::filesystem;

// A copy of the path for the signal handler, which may run at any moment: plain memory that is never freed.
char g_path[PATH_MAX];
std::atomic<bool> g_exists{false};

std::string system_error() { return std::strerror(errno); }

/// `file`, or what it points to.
fs::path resolve(const fs::path& file) {
  std::error_code error;
  if (!fs::is_symlink(file, error)) return file;
  const fs::path target = fs::weakly_canonical(file, error);
  return error ? file : target;
}

void check_target(const fs::path& named, const fs::path& target) {
  if (!named.has_filename()) throw WriteError(named.string(), "names no file");
  std::error_code error;
  const fs::file_status status = fs::status(target, error);
  if (!fs::exists(status)) return;
  if (!fs::is_regular_file(status)) throw WriteError(named.string(), "is not a regular file");
  if (::access(target.c_str(), W_OK) != 0) throw WriteError(named.string(), "is write-protected: " + system_error());
}

fs::path part_path(const fs::path& target, int attempt) {
  return target.parent_path() / (".alhazen-" + std::to_string(::getpid()) + "-" + std::to_string(attempt) + ".part" +
                                 target.extension().string());
}

/// A library's reason, without line breaks.
std::string one_line(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text.empty() ? "cannot be written" : text;
}

/// So that the renaming itself survives a power cut; what cannot be synchronised is no reason to fail.
void sync_folder(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;
  ::fsync(fd);
  ::close(fd);
}

}  // namespace

PartFile::PartFile(const fs::path& target) : named_(target), target_(resolve(target)) {
  check_target(named_, target_);
  for (int attempt = 0; fd_ < 0; ++attempt) {
    part_ = part_path(target_, attempt);
    if (part_.native().size() >= sizeof g_path) throw WriteError(named_.string(), "its path is too long");
    std::strcpy(g_path, part_.c_str());
    fd_ = ::open(part_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (fd_ < 0 && errno != EEXIST)
      throw WriteError(named_.string(), "cannot create a file in its folder: " + system_error());
  }
  g_exists = true;
}

PartFile::~PartFile() {
  if (fd_ >= 0) ::close(fd_);
  if (g_exists.exchange(false)) ::unlink(part_.c_str());
}

void PartFile::write(std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw WriteError(named_.string(), "cannot be written: " + system_error());
    bytes = bytes.subspan(size_t(written));
  }
}

void PartFile::commit() {
  const auto check = [&](int result) {
    if (result != 0) throw WriteError(named_.string(), "cannot be written: " + system_error());
  };
  check(::fsync(fd_));
  check(::close(std::exchange(fd_, -1)));
  check(::rename(part_.c_str(), target_.c_str()));
  g_exists = false;
  sync_folder(target_);
}

void write_whole(const fs::path& file, const std::function<void(PartFile& part)>& write) {
  PartFile part(file);
  try {
    write(part);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw WriteError(file.string(), one_line(error.what()));
  }
  part.commit();
}

void remove_part_file() noexcept {
  if (g_exists) ::unlink(g_path);
}

}  // namespace alhazen
