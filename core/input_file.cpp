#include "core/input_file.h"

#include "core/error.h"

#include <fmt/format.h>

#include <cerrno>
#include <system_error>

namespace lambert {

std::ifstream openInputFile(const std::filesystem::path& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) {
        const bool missing = !error || error == std::errc::no_such_file_or_directory;
        throw InputError(fmt::format("{}: {}", path.string(), missing ? "no such file" : error.message()));
    }
    if (std::filesystem::is_directory(status)) throw InputError(path.string() + ": found a folder, expected a file");
    if (!std::filesystem::is_regular_file(status))
        throw InputError(path.string() + ": found a device or pipe, expected a file");

    std::ifstream stream(path, std::ios::binary);
    if (!stream) throw InputError(fmt::format("{}: {}", path.string(), std::generic_category().message(errno)));
    if (std::filesystem::file_size(path) == 0) throw InputError(path.string() + ": the file is empty");
    return stream;
}

std::string readInputFile(const std::filesystem::path& path) {
    std::ifstream stream = openInputFile(path);
    std::string content(std::filesystem::file_size(path), '\0');
    stream.read(content.data(), static_cast<std::streamsize>(content.size()));
    if (stream.bad() || static_cast<std::size_t>(stream.gcount()) != content.size())
        throw InputError(path.string() + ": cannot be read to its end");
    return content;
}

} // namespace lambert
