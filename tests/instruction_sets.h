#pragma once

#include "scene/rays/packet_width.h"

#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

namespace lambert {

/// What Embree has kernels for, as it calls them, and this processor too; the first is the least. (Of what a processor lacks Embree 3
/// makes the best that it has; Embree 4 does not start.)
inline std::vector<const char*> instructionSets() {
    std::vector<const char*> sets{"sse2"};
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx")) sets.push_back("avx");
    if (__builtin_cpu_supports("avx2")) sets.push_back("avx2");
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
        sets.push_back("avx512");
#endif
    return sets;
}

/// While it lives, what casters are made traces with the kernels of an instruction set.
class InstructionSet {
public:
    explicit InstructionSet(const char* name) {
        if (const char* before = std::getenv(kEmbreeVariable); before != nullptr) before_ = before;
        setenv(kEmbreeVariable, (std::string("isa=") + name).c_str(), 1);
    }
    ~InstructionSet() {
        if (before_)
            setenv(kEmbreeVariable, before_->c_str(), 1);
        else
            unsetenv(kEmbreeVariable);
    }
    InstructionSet(const InstructionSet&) = delete;
    InstructionSet& operator=(const InstructionSet&) = delete;

private:
    std::optional<std::string> before_;
};

/// What `make()` returns under an instruction set.
template <typename Make>
auto with(const char* set, Make make) {
    const InstructionSet guard(set);
    return make();
}

} // namespace lambert
