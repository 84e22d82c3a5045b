#include "core/whole_file.h"

#include "core/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

namespace lambert {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, int error) {
    throw SystemError(fmt::format("{}: cannot write: {}", path.string(), std::strerror(error)));
}

fs::path temporaryName(const fs::path& path) {
    // Short, as the target's own name may be as long as a name can be. The extension stays last: image libraries choose
    // the format by it.
    fs::path name = fmt::format(".lambert-{}.tmp", ::getpid());
    name += path.extension();
    return path.parent_path() / name;
}

void flushToDisk(const fs::path& temporary, const fs::path& path) {
    const int file = ::open(temporary.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) fail(path, errno);
    const int result = ::fsync(file);
    const int error = errno;
    ::close(file);
    if (result != 0) fail(path, error);
}

} // namespace

void writeWholeFile(const fs::path& path, const std::function<void(const fs::path&)>& write) {
    const fs::path temporary = temporaryName(path);
    try {
        write(temporary);
        flushToDisk(temporary, path);
        std::error_code error;
        fs::rename(temporary, path, error);
        if (error) fail(path, error.value());
    } catch (...) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw;
    }
}

void writeWholeFile(const fs::path& path, std::string_view content) {
    writeWholeFile(path, [&](const fs::path& temporary) {
        errno = 0;
        std::ofstream file(temporary, std::ios::binary);
        file.write(content.data(), static_cast<std::streamsize>(content.size()));
        file.close();
        if (!file) fail(path, errno != 0 ? errno : EIO);
    });
}

void requireWritable(const fs::path& path) {
    std::error_code error;
    if (fs::is_directory(path, error)) fail(path, EISDIR);
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (fs::exists(folder, error) && !fs::is_directory(folder, error)) fail(path, ENOTDIR);
    if (::access(folder.c_str(), W_OK | X_OK) != 0) fail(path, errno);
}

} // namespace lambert
