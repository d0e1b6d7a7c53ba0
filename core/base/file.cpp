#include "core/base/file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include "core/base/text.h"

namespace lightvane {
namespace fs = std::filesystem;

std::string fileEnding(const fs::path& path) { return lowered(path.extension().string()); }

namespace {

/// All that is written to a pipe, looking at the watch while nothing comes.
Expected<std::string> readPipe(const fs::path& path, LoadWatch& watch) {
  constexpr int kMillisecondsPerLook = 20;
  const int file = open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return makeError(path.string(), fmt::format("cannot be opened: {}", std::strerror(errno)));
  const struct Closer {
    int file;
    ~Closer() { close(file); }
  } closer{file};
  std::string content;
  std::array<char, 1 << 16> chunk;
  while (true) {
    watch.look();
    pollfd asked{file, POLLIN, 0};
    if (poll(&asked, 1, kMillisecondsPerLook) <= 0) continue;
    const ssize_t count = read(file, chunk.data(), chunk.size());
    if (count > 0) content.append(chunk.data(), static_cast<std::size_t>(count));
    if (count == 0) return content;
    if (count < 0 && errno != EAGAIN && errno != EINTR)
      return makeError(path.string(), fmt::format("cannot be read: {}", std::strerror(errno)));
  }
}

}  // namespace

Expected<std::string> readFile(const fs::path& path, LoadWatch& watch) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) return makeError(path.string(), "no such file");
  if (fs::is_directory(status)) return makeError(path.string(), "is a folder, not a file");
  if (fs::is_fifo(status)) return readPipe(path, watch);
  // Devices have no end.
  if (!fs::is_regular_file(status)) return makeError(path.string(), "is not a regular file");
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) return makeError(path.string(), fmt::format("cannot be opened: {}", std::strerror(errno)));
  const std::uintmax_t size = fs::file_size(path, error);
  std::string content;
  // A millisecond's work from memory.
  constexpr std::size_t kChunk = std::size_t{1} << 20;
  if (!error) content.reserve(size + kChunk);
  while (in) {
    const std::size_t before = content.size();
    watch.look(static_cast<double>(before) / static_cast<double>(std::max<std::uintmax_t>(size, before + 1)));
    content.resize(before + kChunk);
    in.read(content.data() + before, kChunk);
    content.resize(before + static_cast<std::size_t>(in.gcount()));
  }
  if (in.bad()) return makeError(path.string(), fmt::format("cannot be read: {}", std::strerror(errno)));
  return content;
}

Expected<void> replaceFileAtomically(const fs::path& path,
                                     const std::function<Expected<void>(const fs::path&)>& write) {
  // A link stays one: what it points to is replaced.
  std::error_code unresolved;
  fs::path target = fs::is_symlink(path, unresolved) ? fs::canonical(path, unresolved) : path;
  if (unresolved) target = path;
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    return makeError(path.string(), fmt::format("the folder {} does not exist", folder.string()),
                     "create it first");
  }
  if (fs::is_directory(target, error)) return makeError(path.string(), "is a folder, not a file");
  // The extension stays last: libraries choose a format by it.
  const fs::path temporary =
      folder / fmt::format(".{}.{}.tmp{}", target.stem().string(), getpid(), target.extension().string());
  Expected<void> written = write(temporary);
  if (written) {
    fs::rename(temporary, target, error);
    if (error) written = makeError(path.string(), fmt::format("cannot be replaced: {}", error.message()));
  } else {
    written.error().where = path.string();
  }
  std::error_code ignored;
  if (!written) fs::remove(temporary, ignored);
  return written;
}

Expected<void> writeFileAtomically(const fs::path& path, std::string_view content) {
  return replaceFileAtomically(path, [&](const fs::path& temporary) -> Expected<void> {
    errno = 0;
    std::ofstream out(temporary, std::ios::binary);
    out.write(content.data(), static_cast<std::streamsize>(content.size()));
    out.close();
    if (!out)
      return makeError(temporary.string(), fmt::format("cannot be written: {}", std::strerror(errno)));
    return {};
  });
}

}  // namespace lightvane
