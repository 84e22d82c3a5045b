#include "scene/mgf/file.h"

#include "core/error.h"
#include "core/input_file.h"
#include "core/text.h"
#include "scene/named_file.h"
#include "scene/reading.h"
#include "scene/words.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <utility>

namespace lambert {

namespace {

constexpr std::string_view kExtension = ".mgf";
constexpr std::string_view kSpaces = " \t\v\f\r\n";

std::string placeIn(const std::string& file, std::size_t line) {
    return fmt::format("{}:{}", std::filesystem::path(file).filename().string(), line);
}

} // namespace

MgfEntity::MgfEntity(const std::string& file, std::size_t line, std::string_view text)
    : file_(&file), line_(line), words_(wordsOf(text)) {}

double MgfEntity::number(std::size_t k) const {
    const auto value = parseNumber(argument(k));
    if (!value || !std::isfinite(*value)) fail(argument(k), "a finite number");
    return *value;
}

std::int64_t MgfEntity::integer(std::size_t k, std::int64_t lowest, std::int64_t highest) const {
    const std::string_view word = argument(k);
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value < lowest || value > highest)
        fail(word, fmt::format("a whole number from {} to {}", lowest, highest));
    return value;
}

std::string MgfEntity::place() const { return placeIn(*file_, line_); }

void MgfEntity::requireArguments(std::size_t least, std::size_t most, const std::string& expected) const {
    if (argumentCount() < least || argumentCount() > most) fail(expected);
}

void MgfEntity::fail(std::string_view found, const std::string& expected) const {
    failAt(*file_, line_, found, expected);
}

void MgfEntity::fail(const std::string& expected) const {
    std::string found;
    for (const std::string_view word : words_) {
        if (!found.empty()) found += ' ';
        found += word;
        if (found.size() > 60) break; // more is not shown
    }
    fail(found, expected);
}

MgfFile::MgfFile(const std::filesystem::path& path, std::filesystem::path nameInScene)
    : name_(path.string()), nameInScene_(std::move(nameInScene)), text_(readInputFile(path)) {
    joinContinuedLines();
    findEntities();
}

/// Replaces a backslash and the end of the line after it by spaces, among them one '\v' that still counts as a line.
void MgfFile::joinContinuedLines() {
    std::replace(text_.begin(), text_.end(), '\v', ' ');
    if (text_.starts_with("\xEF\xBB\xBF")) text_.replace(0, 3, "   ");
    for (std::size_t k = text_.find('\\'); k != std::string::npos; k = text_.find('\\', k + 1)) {
        const std::size_t next = k + 1;
        if (next < text_.size() && text_[next] != '\r' && text_[next] != '\n') continue;
        text_[k] = '\t';
        if (next == text_.size()) continue;
        const bool both = text_[next] == '\r' && next + 1 < text_.size() && text_[next + 1] == '\n';
        text_[next] = '\v';
        if (both) text_[next + 1] = '\t';
    }
}

void MgfFile::findEntities() {
    std::size_t number = 1;
    for (std::size_t begin = 0; begin < text_.size(); ++number) {
        const std::size_t end = std::min(text_.find_first_of("\r\n", begin), text_.size());
        const std::string_view line = std::string_view(text_).substr(begin, end - begin);
        const std::size_t word = line.find_first_not_of(kSpaces);
        if (word != std::string_view::npos && line[word] != '#') {
            const auto joinedBefore = std::count(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(word), '\v');
            lines_.push_back({number + static_cast<std::size_t>(joinedBefore), begin + word, line.size() - word});
        }
        number += static_cast<std::size_t>(std::count(line.begin(), line.end(), '\v'));
        begin = end + (std::string_view(text_).substr(end, 2) == "\r\n" ? 2 : 1);
    }
}

MgfEntity MgfFile::entity(std::size_t k) const {
    const Line& line = lines_[k];
    return {name_, line.number, std::string_view(text_).substr(line.begin, line.length)};
}

std::string MgfFile::place(std::size_t line) const { return placeIn(name_, line); }

std::filesystem::path includedName(const MgfFile& includer, const MgfEntity& include) {
    return (includer.nameInScene().parent_path() / std::filesystem::path(include.argument(0))).lexically_normal();
}

bool isMgf(const std::filesystem::path& path) { return lowerCase(path.extension().string()) == kExtension; }

std::vector<std::filesystem::path> filesOfMgf(const std::filesystem::path& path) {
    const std::filesystem::path folder = path.parent_path();
    ReadOptions anywhere;
    anywhere.allowOutsideFiles = true; // reading decides about that; here every file counts
    std::vector<std::filesystem::path> files{path}, names{path.filename()};
    const auto canonical = [](const std::filesystem::path& file) {
        std::error_code error;
        return std::filesystem::weakly_canonical(file, error).string();
    };
    std::set<std::string> known{canonical(path)};
    for (std::size_t next = 0; next < files.size(); ++next) {
        try {
            const MgfFile file(files[next], names[next]);
            for (std::size_t k = 0; k < file.size(); ++k) {
                const MgfEntity entity = file.entity(k);
                if (entity.keyword() != "i" || entity.argumentCount() == 0) continue;
                const std::filesystem::path name = includedName(file, entity);
                const std::filesystem::path included = namedFile(folder, name.string(), anywhere);
                if (!known.insert(canonical(included)).second) continue;
                files.push_back(included);
                names.push_back(name);
            }
        } catch (const InputError&) {
            continue; // reported when the scene is read
        }
    }
    return files;
}

} // namespace lambert
