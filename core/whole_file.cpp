#include "core/whole_file.h"

#include "core/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <deque>
#include <fstream>

namespace lambert {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void fail(const fs::path& path, int error) {
    throw SystemError(fmt::format("{}: cannot write: {}", path.string(), std::strerror(error)));
}

/// A new content on its way to replace a file: removed again unless committed.
class Replacement {
public:
    /// `number` tells apart what one process replaces at one time. The temporary name is short, as the target's own name may
    /// be as long as a name can be.
    explicit Replacement(const fs::path& path, std::size_t number = 0)
        : path_(path), temporary_(path.parent_path() / fmt::format(".lambert-{}-{}.tmp", ::getpid(), number)) {}
    ~Replacement() {
        std::error_code ignored;
        if (!committed_) fs::remove(temporary_, ignored);
    }
    Replacement(const Replacement&) = delete;
    Replacement& operator=(const Replacement&) = delete;

    void write(const std::function<void(std::ostream&)>& content) const {
        errno = 0;
        std::ofstream file(temporary_, std::ios::binary);
        content(file);
        file.close();
        if (!file) fail(path_, errno != 0 ? errno : EIO);
        flush();
    }

    void write(std::string_view content) const {
        write([&](std::ostream& file) { file.write(content.data(), static_cast<std::streamsize>(content.size())); });
    }

    void commit() {
        std::error_code error;
        fs::rename(temporary_, path_, error);
        if (error) fail(path_, error.value());
        committed_ = true;
    }

private:
    void flush() const {
        const int file = ::open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
        if (file < 0) fail(path_, errno);
        const int result = ::fsync(file);
        const int error = errno;
        ::close(file);
        if (result != 0) fail(path_, error);
    }

    fs::path path_, temporary_;
    bool committed_ = false;
};

} // namespace

void writeWholeFile(const fs::path& path, std::string_view content) {
    Replacement replacement(path);
    replacement.write(content);
    replacement.commit();
}

void writeWholeFile(const fs::path& path, const std::function<void(std::ostream&)>& content) {
    Replacement replacement(path);
    replacement.write(content);
    replacement.commit();
}

void writeWholeFiles(std::span<const FileContent> files) {
    std::deque<Replacement> replacements;
    for (const FileContent& file : files) replacements.emplace_back(file.path, replacements.size()).write(file.content);
    for (Replacement& replacement : replacements) replacement.commit();
}

void writeWholeFiles(std::span<const FileStream> files) {
    std::deque<Replacement> replacements;
    for (const FileStream& file : files) replacements.emplace_back(file.path, replacements.size()).write(file.content);
    for (Replacement& replacement : replacements) replacement.commit();
}

void requireWritable(const fs::path& path) {
    std::error_code error;
    if (fs::is_directory(path, error)) fail(path, EISDIR);
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (fs::exists(folder, error) && !fs::is_directory(folder, error)) fail(path, ENOTDIR);
    if (::access(folder.c_str(), W_OK | X_OK) != 0) fail(path, errno);
}

} // namespace lambert
