#include "scene/input_file.h"

#include "core/error.h"
#include "scene/scene_reader.h"

#include <boost/locale/utf.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <system_error>

namespace lambert {

namespace {

/// Cuts after `length` bytes, but not inside a UTF-8 sequence.
std::string_view shortened(std::string_view text, std::size_t length) {
    if (text.size() <= length) return text;
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80) --length;
    return text.substr(0, length);
}

/// The entry of `folder` that has this name but for the case of its letters, or the name itself.
std::filesystem::path matchCase(const std::filesystem::path& folder, const std::filesystem::path& name) {
    std::error_code error;
    const std::filesystem::path here = folder.empty() ? std::filesystem::path(".") : folder;
    if (std::filesystem::exists(here / name, error)) return name;
    std::filesystem::path found = name;
    std::size_t matches = 0;
    for (std::filesystem::directory_iterator entry(here, error), end; !error && entry != end; entry.increment(error)) {
        if (lowerCase(entry->path().filename().string()) != lowerCase(name.string())) continue;
        // The smallest of several: folders have no order of their own.
        if (matches++ == 0 || entry->path().filename() < found) found = entry->path().filename();
    }
    return found;
}

bool isControl(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

} // namespace

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

std::filesystem::path namedFile(const std::filesystem::path& folder, const std::string& name,
                                const ReadOptions& options) {
    std::string forward = name;
    std::error_code error;
    if (!std::filesystem::exists(folder / name, error)) {
        forward = asUtf8(name); // Latin-1 may have been converted with the file's system or not
        if (!std::filesystem::exists(folder / forward, error)) std::replace(forward.begin(), forward.end(), '\\', '/');
    }
    const std::filesystem::path start = folder.empty() ? std::filesystem::path(".") : folder;
    std::filesystem::path path = start;
    for (const std::filesystem::path& part : std::filesystem::path(forward)) path /= matchCase(path, part);
    if (options.allowOutsideFiles) return path;

    const auto home = std::filesystem::weakly_canonical(std::filesystem::absolute(start), error);
    const auto target = std::filesystem::weakly_canonical(std::filesystem::absolute(path), error);
    const auto [inHome, inTarget] = std::mismatch(home.begin(), home.end(), target.begin(), target.end());
    if (error || inHome != home.end())
        throw InputError(fmt::format("{} lies outside the scene's folder; --allow-outside-files reads it all the same",
                                     inQuotes(name)));
    return path;
}

std::string asUtf8(std::string_view text) {
    using Utf8 = boost::locale::utf::utf_traits<char>;
    bool valid = true;
    for (auto next = text.begin(); valid && next != text.end();)
        valid = boost::locale::utf::is_valid_codepoint(Utf8::decode(next, text.end()));
    if (valid) return std::string(text);
    std::string result;
    for (const char byte : text) Utf8::encode(static_cast<unsigned char>(byte), std::back_inserter(result));
    return result;
}

std::string lowerCase(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
}

std::string inQuotes(std::string_view text) {
    std::string result = "\"";
    const std::string_view start = shortened(text, 60);
    for (const char c : start) result += isControl(c) ? (c == '\t' ? ' ' : '?') : c;
    if (start.size() < text.size()) result += "...";
    return result + '"';
}

std::string oneLine(std::string_view text, std::size_t maxLength) {
    while (!text.empty() && isControl(text.back())) text.remove_suffix(1);
    std::string result;
    const std::string_view start = shortened(text, maxLength);
    for (const char c : start) {
        if (c == '\n') {
            result += "; ";
        } else if (c != '\r') {
            result += isControl(c) ? '?' : c;
        }
    }
    if (start.size() < text.size()) result += "...";
    return result;
}

} // namespace lambert
