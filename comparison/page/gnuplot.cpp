#include "comparison/page/gnuplot.h"

#include "core/error.h"
#include "core/memory_file.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <thread>

extern char** environ; // NOLINT(readability-redundant-declaration): POSIX has it in no header

namespace lambert {

namespace {

constexpr std::chrono::milliseconds kPollInterval{2};

[[noreturn]] void fail(const std::string& why) { throw SystemError("gnuplot: " + why); }

/// A running gnuplot; killed if it is left before its end.
class Child {
public:
    Child(const MemoryFile& in, const MemoryFile& out, const MemoryFile& complaints) {
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, in.descriptor(), STDIN_FILENO);
        posix_spawn_file_actions_adddup2(&actions, out.descriptor(), STDOUT_FILENO);
        posix_spawn_file_actions_adddup2(&actions, complaints.descriptor(), STDERR_FILENO);
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
        ::waitpid(process_, nullptr, 0);
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// Its exit status, 0 if all is well. Throws Cancelled.
    int wait(const Progress& progress) {
        int status = 0;
        for (progress.throwIfCancelled(); ::waitpid(process_, &status, WNOHANG) == 0; progress.throwIfCancelled())
            std::this_thread::sleep_for(kPollInterval);
        process_ = 0;
        return status;
    }

private:
    pid_t process_ = 0;
};

std::string contentOf(const MemoryFile& memory) {
    std::ifstream file(memory.path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

} // namespace

void requireGnuplot() { runGnuplot("exit\n", Progress()); }

std::string runGnuplot(const std::string& script, const Progress& progress) {
    const MemoryFile in(script), out, complaints;
    if (Child(in, out, complaints).wait(progress) != 0) {
        progress.throwIfCancelled(); // Ctrl-C goes to both
        const std::string errors = contentOf(complaints);
        const std::size_t from = errors.find_first_not_of(" \t\r\n");
        fail(from == std::string::npos ? "failed" : errors.substr(from, errors.find('\n', from) - from));
    }
    return contentOf(out);
}

} // namespace lambert
