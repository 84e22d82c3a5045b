#include "comparison/page/gnuplot.h"

#include "core/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string_view>

extern char** environ; // NOLINT(readability-redundant-declaration): POSIX has it in no header

namespace lambert {

namespace {

constexpr int kPollMilliseconds = 100;

[[noreturn]] void fail(const std::string& why) { throw SystemError("gnuplot: " + why); }

/// Both ends of a pipe, closed in time.
class Pipe {
public:
    Pipe() {
        if (::pipe2(ends_.data(), O_CLOEXEC) != 0) fail(std::strerror(errno));
    }
    ~Pipe() {
        close(0);
        close(1);
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    int operator[](std::size_t end) const { return ends_[end]; }
    void close(std::size_t end) {
        if (ends_[end] >= 0) ::close(ends_[end]);
        ends_[end] = -1;
    }

private:
    std::array<int, 2> ends_{-1, -1};
};

/// A running gnuplot; killed if it is left before its end.
class Child {
public:
    Child(const Pipe& in, const Pipe& out, const Pipe& complaints) {
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, in[0], STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions, out[1], STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&actions, complaints[1], STDERR_FILENO);
        // Without --default-settings a user's ~/.gnuplot would have its say.
        std::array<std::string, 2> words{"gnuplot", "--default-settings"};
        std::array<char*, 3> arguments{words[0].data(), words[1].data(), nullptr};
        const int error = ::posix_spawnp(&process_, "gnuplot", &actions, nullptr, arguments.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        if (error == ENOENT) fail("not found; plots need Debian's package gnuplot-nox (apt-get install gnuplot-nox)");
        if (error != 0) fail(std::strerror(error));
    }
    ~Child() {
        if (process_ <= 0) return;
        ::kill(process_, SIGKILL);
        wait();
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// Its exit status, 0 if all is well.
    int wait() {
        int status = 0;
        while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
        }
        process_ = 0;
        return status;
    }

private:
    pid_t process_ = 0;
};

/// Appends what is there to be read; false at the end.
bool readSome(int file, std::string& text) {
    std::array<char, 65536> buffer;
    const ssize_t count = ::read(file, buffer.data(), buffer.size());
    if (count > 0) text.append(buffer.data(), static_cast<std::size_t>(count));
    return count > 0 || (count < 0 && errno == EINTR);
}

/// Feeds and reads at once, so that neither side waits for the other forever.
void exchange(Pipe& in, Pipe& out, Pipe& complaints, std::string_view script, std::string& output, std::string& errors,
              const Progress& progress) {
    ::fcntl(in[1], F_SETFL, O_NONBLOCK);
    while (out[0] >= 0 || complaints[0] >= 0) {
        progress.throwIfCancelled();
        std::array<pollfd, 3> files{pollfd{in[1], POLLOUT, 0}, pollfd{out[0], POLLIN, 0},
                                    pollfd{complaints[0], POLLIN, 0}};
        if (::poll(files.data(), files.size(), kPollMilliseconds) < 0 && errno != EINTR) fail(std::strerror(errno));
        if (files[0].revents != 0) {
            const ssize_t written = ::write(in[1], script.data(), script.size());
            if (written > 0) script.remove_prefix(static_cast<std::size_t>(written));
            if ((written < 0 && errno != EAGAIN && errno != EINTR) || script.empty()) in.close(1);
        }
        if (files[1].revents != 0 && !readSome(out[0], output)) out.close(0);
        if (files[2].revents != 0 && !readSome(complaints[0], errors)) complaints.close(0);
    }
}

} // namespace

void requireGnuplot() { runGnuplot("exit\n", Progress()); }

std::string runGnuplot(const std::string& script, const Progress& progress) {
    Pipe in, out, complaints;
    Child child(in, out, complaints);
    in.close(0);
    out.close(1);
    complaints.close(1);
    std::string output, errors;
    exchange(in, out, complaints, script, output, errors, progress);
    if (child.wait() != 0) {
        progress.throwIfCancelled(); // Ctrl-C goes to both
        const std::size_t from = errors.find_first_not_of(" \t\r\n");
        fail(from == std::string::npos ? "failed" : errors.substr(from, errors.find('\n', from) - from));
    }
    return output;
}

} // namespace lambert
