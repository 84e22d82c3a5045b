#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>

namespace lambert {

/// As long as it lives, nothing reaches standard error: libpng, libtiff and their like print there what OpenImageIO reports
/// as an error as well, and the program says it once, in its own words. Of the whole process: for the thread that reads a
/// scene, while no other logs. Does nothing under a sanitizer, whose reports must be seen.
class QuietLibraries {
public:
    QuietLibraries() {
#ifndef LAMBERT_SANITIZED
        std::fflush(stderr);
        saved_ = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
        const int nowhere = saved_ >= 0 ? ::open("/dev/null", O_WRONLY | O_CLOEXEC) : -1;
        if (nowhere < 0) return;
        ::dup2(nowhere, STDERR_FILENO);
        ::close(nowhere);
#endif
    }
    ~QuietLibraries() {
        if (saved_ < 0) return;
        std::fflush(stderr);
        ::dup2(saved_, STDERR_FILENO);
        ::close(saved_);
    }
    QuietLibraries(const QuietLibraries&) = delete;
    QuietLibraries& operator=(const QuietLibraries&) = delete;

private:
    int saved_ = -1; //!< another descriptor of what standard error was
};

} // namespace lambert
