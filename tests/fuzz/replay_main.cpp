#include "hostile_file.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> inputsOf(const fs::path& place) {
    if (!fs::is_directory(place)) return {place};
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(place))
        if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

std::string contentOf(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

} // namespace

/// fuzz_replay FORMAT (FILE | FOLDER)...: what the fuzzer of a format does, once for each of the files, under any compiler.
int main(int argc, char** argv) {
    if (argc < 3) {
        std::fprintf(stderr, "usage: %s FORMAT (FILE | FOLDER)...\n", argv[0]);
        return 2;
    }
    int failures = 0;
    std::size_t count = 0;
    for (int k = 2; k < argc; ++k) {
        for (const fs::path& file : inputsOf(argv[k])) {
            ++count;
            std::fprintf(stderr, "%s\n", file.c_str()); // before the input: it may end the program
            try {
                lambert::readHostileFile(argv[1], contentOf(file));
            } catch (const std::exception& error) {
                std::fprintf(stderr, "  failed: %s\n", error.what());
                ++failures;
            }
        }
    }
    std::fprintf(stderr, "%zu inputs, %d failed\n", count, failures);
    return count == 0 || failures > 0 ? 1 : 0;
}
