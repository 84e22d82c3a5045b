#include "core/locked_file.h"

#include "core/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace lambert {

namespace {

/// Whether the file still has the name: who held the lock before may have removed it.
bool hasName(int file, const std::filesystem::path& path) {
    struct stat opened {
    }, named{};
    return ::fstat(file, &opened) == 0 && ::stat(path.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
           opened.st_ino == named.st_ino;
}

} // namespace

LockedFile::LockedFile(std::filesystem::path path, const std::filesystem::path& checkpoint) : path_(std::move(path)) {
    do {
        if (file_ >= 0) ::close(file_);
        file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (file_ < 0 || ::flock(file_, LOCK_EX | LOCK_NB) != 0) {
            const int error = errno;
            if (file_ >= 0) ::close(file_);
            if (file_ >= 0 && error == EWOULDBLOCK)
                throw UsageError(fmt::format("--checkpoint: {} is in use by another run", checkpoint.string()));
            throw SystemError(fmt::format("{}: cannot write the checkpoint: {}", path_.string(), std::strerror(error)));
        }
    } while (!hasName(file_, path_));
}

LockedFile::~LockedFile() { ::close(file_); }

void LockedFile::remove() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
}

} // namespace lambert
