#include "core/whole_file.h"

#include "core/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <deque>
#include <fstream>
#include <optional>
#include <random>

namespace lambert {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostNameless = 256; ///< at a time: they stay open, and 1024 open files are allowed as a rule

[[noreturn]] void fail(const fs::path& path, int error) {
    throw SystemError(fmt::format("{}: cannot write: {}", path.string(), std::strerror(error)));
}

void writePiece(std::ostream& file, std::string_view content) {
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
}

/// A file open for writing that has no name: it vanishes with this process, however that ends. Not every file system has them.
class NamelessFile {
public:
    explicit NamelessFile(const fs::path& folder)
        : descriptor_(::open(folder.empty() ? "." : folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666)),
          path_(fmt::format("/proc/self/fd/{}", descriptor_)) {}
    ~NamelessFile() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    NamelessFile(const NamelessFile&) = delete;
    NamelessFile& operator=(const NamelessFile&) = delete;

    bool usable() const { return descriptor_ >= 0 && ::access(path_.c_str(), W_OK) == 0; }
    /// Under which this process can open it.
    const fs::path& path() const { return path_; }
    /// False, with errno set, if there is a file of that name.
    bool giveName(const fs::path& name) const {
        return ::linkat(AT_FDCWD, path_.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
    }

private:
    int descriptor_;
    fs::path path_;
};

/// A new content on its way to replace a file: removed again unless committed.
class Replacement {
public:
    explicit Replacement(const fs::path& path) : path_(path) {}
    ~Replacement() {
        std::error_code ignored;
        if (!temporary_.empty()) fs::remove(temporary_, ignored);
    }
    Replacement(const Replacement&) = delete;
    Replacement& operator=(const Replacement&) = delete;

    /// To a file without a name, if wanted and possible.
    void write(const std::function<void(std::ostream&)>& content, bool nameless) {
        if (nameless && !nameless_.emplace(path_.parent_path()).usable()) nameless_.reset();
        if (!nameless_)
            takeName([](const fs::path& name) {
                const int file = ::open(name.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
                return file >= 0 && ::close(file) == 0;
            });
        writeTo(nameless_ ? nameless_->path() : temporary_, content);
    }

    void write(std::string_view content, bool nameless) {
        write([&](std::ostream& file) { writePiece(file, content); }, nameless);
    }

    void giveName() {
        if (nameless_) takeName([&](const fs::path& name) { return nameless_->giveName(name); });
        nameless_.reset();
    }

    void commit() {
        std::error_code error;
        fs::rename(temporary_, path_, error);
        if (error) fail(path_, error.value());
        temporary_.clear();
    }

private:
    /// `create` makes a file of a name that none has, whoever else writes to this folder: numbers of processes recur on machines
    /// that share it. The name is short, as the target's own may be as long as a name can be.
    template <typename Create>
    void takeName(const Create& create) {
        for (;;) {
            std::random_device random;
            const fs::path name = path_.parent_path() / fmt::format(".lambert-{:08x}{:08x}.tmp", random(), random());
            if (create(name)) {
                temporary_ = name;
                return;
            }
            if (errno != EEXIST) fail(path_, errno);
        }
    }

    /// Until it is on the disk.
    void writeTo(const fs::path& target, const std::function<void(std::ostream&)>& content) const {
        errno = 0;
        std::ofstream stream(target, std::ios::binary);
        content(stream);
        stream.close();
        if (!stream) fail(path_, errno != 0 ? errno : EIO);

        const int file = ::open(target.c_str(), O_RDONLY | O_CLOEXEC);
        if (file < 0) fail(path_, errno);
        const int result = ::fsync(file);
        const int error = errno;
        ::close(file);
        if (result != 0) fail(path_, error);
    }

    fs::path path_;
    fs::path temporary_; ///< empty: none
    std::optional<NamelessFile> nameless_;
};

/// All or none. A name is given and taken when everything is on the disk: a moment, whatever the sizes.
template <class File>
void writeAll(std::span<const File> files) {
    std::deque<Replacement> replacements;
    for (const File& file : files) {
        const bool nameless = replacements.size() < kMostNameless;
        replacements.emplace_back(file.path).write(file.content, nameless);
    }
    for (Replacement& replacement : replacements) replacement.giveName();
    for (Replacement& replacement : replacements) replacement.commit();
}

} // namespace

void writeWholeFile(const fs::path& path, std::string_view content) {
    writeWholeFile(path, [&](std::ostream& file) { writePiece(file, content); });
}

void writeWholeFile(const fs::path& path, const std::function<void(std::ostream&)>& content) {
    writeWholeFiles(std::array{FileStream{path, content}});
}

void writeWholeFiles(std::span<const FileContent> files) { writeAll(files); }

void writeWholeFiles(std::span<const FileStream> files) { writeAll(files); }

void requireWritable(const fs::path& path) {
    std::error_code error;
    if (fs::is_directory(path, error)) fail(path, EISDIR);
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (fs::exists(folder, error) && !fs::is_directory(folder, error)) fail(path, ENOTDIR);
    if (::access(folder.c_str(), W_OK | X_OK) != 0) fail(path, errno);
}

} // namespace lambert
