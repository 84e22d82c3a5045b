#include "cli/commands.h"
#include "cli/failure.h"
#include "cli/terminal_text.h"
#include "core/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

namespace {

using lambert::ExitCode;

int fail(ExitCode code, const std::string& message) {
    lambert::writeLog("lambert: " + lambert::printable(message) + "\n");
    return static_cast<int>(code);
}

/// Results that did not reach standard output are a failure.
int finish(ExitCode code) {
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
        return fail(ExitCode::System, "standard output cannot be written");
    return static_cast<int>(code);
}

int run(int argc, char** argv) {
    CLI::App program("Finite-element radiosity: bakes the light of a scene into vertex colours.", "lambert");
    program.set_version_flag("--version", LAMBERT_VERSION);
    program.require_subcommand(1);
    lambert::CommandRun command;
    lambert::addBakeCommand(program, command);
    lambert::addFormFactorsCommand(program, command);
    lambert::addProbeCommand(program, command);
    lambert::addCompareCommand(program, command);
    lambert::addInfoCommand(program, command);
    lambert::addVerifyCommand(program, command);
    try {
        program.parse(argc, argv);
    } catch (const CLI::Success& help) {
        return finish(static_cast<ExitCode>(program.exit(help)));
    } catch (const CLI::RequiredError& error) {
        if (program.get_subcommands().empty() && argc > 1 && argv[1][0] != '-')
            return fail(ExitCode::Usage,
                        fmt::format("no command \"{}\": there are bake, formfactors, probe, compare, info and verify",
                                    argv[1]));
        return fail(ExitCode::Usage, std::string(error.what()) + " (lambert --help)");
    } catch (const CLI::ParseError& error) {
        return fail(ExitCode::Usage, std::string(error.what()) + " (lambert --help)");
    }
    return finish(command());
}

/// A closed stdin, stdout or stderr is occupied, or the next file to be opened would become it. Writing to it fails as before.
void occupyStandardStreams() {
    int file = 0;
    while (file >= 0 && file <= STDERR_FILENO) file = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (file >= 0) ::close(file);
}

} // namespace

int main(int argc, char** argv) {
    occupyStandardStreams();
    // A pipe closed early or a file that may not grow is an error of writing, not a silent death.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    lambert::returnLargeBlocks();
    try {
        return run(argc, argv);
    } catch (...) {
        const lambert::Failure failure = lambert::currentFailure();
        return fail(failure.code, failure.message);
    }
}
