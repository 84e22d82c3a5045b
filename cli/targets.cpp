#include "cli/targets.h"

#include "core/error.h"
#include "core/whole_file.h"

#include <fmt/format.h>

namespace lambert {

namespace fs = std::filesystem;

namespace {

bool sameFile(const fs::path& a, const fs::path& b) {
    std::error_code error;
    if (fs::equivalent(a, b, error)) return true;
    const fs::path wholeA = fs::weakly_canonical(fs::absolute(a), error);
    if (error) return false;
    const fs::path wholeB = fs::weakly_canonical(fs::absolute(b), error);
    return !error && wholeA == wholeB;
}

} // namespace

void checkTargets(std::span<const fs::path> targets, std::span<const fs::path> inputs) {
    for (std::size_t i = 0; i < targets.size(); ++i) {
        if (targets[i].empty()) continue;
        if (targets[i].native().starts_with("--"))
            throw UsageError(fmt::format("{0}: is an option where a file is to be named; if it is one, write ./{0}",
                                         targets[i].string()));
        for (const fs::path& input : inputs)
            if (sameFile(targets[i], input))
                throw UsageError(fmt::format("{}: would overwrite {}", targets[i].string(),
                                             sameFile(input, inputs.front()) ? "the scene" : "what is read"));
        for (std::size_t j = 0; j < i; ++j)
            if (!targets[j].empty() && sameFile(targets[i], targets[j]))
                throw UsageError(fmt::format("{}: named twice as a target", targets[i].string()));
        requireWritable(targets[i]);
        std::error_code ignored;
        if (fs::exists(targets[i], ignored) && !fs::is_regular_file(targets[i], ignored))
            throw SystemError(
                fmt::format("{}: cannot write: a device or pipe cannot be replaced by a file", targets[i].string()));
    }
}

} // namespace lambert
