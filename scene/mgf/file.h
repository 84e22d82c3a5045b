#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace lambert {

/// An entity of an MGF file: a keyword and its arguments. The failing functions throw InputError with file and line.
class MgfEntity {
public:
    /// `text` holds at least one word; it and `file` must outlive the entity.
    MgfEntity(const std::string& file, std::size_t line, std::string_view text);

    const std::string& file() const { return *file_; }
    std::size_t line() const { return line_; }
    std::string_view keyword() const { return words_.front(); }
    std::size_t argumentCount() const { return words_.size() - 1; }
    /// Argument 0 is the one after the keyword.
    std::string_view argument(std::size_t k) const { return words_[k + 1]; }
    /// A finite number.
    double number(std::size_t k) const;
    /// A whole number from `lowest` to `highest`.
    std::int64_t integer(std::size_t k, std::int64_t lowest, std::int64_t highest) const;

    /// "file:line" without the folder, for warnings.
    std::string place() const;

    /// Fails unless there are `least` to `most` arguments; `expected` says which ("cxy x y").
    void requireArguments(std::size_t least, std::size_t most, const std::string& expected) const;
    [[noreturn]] void fail(std::string_view found, const std::string& expected) const;
    /// Fails with the whole entity as what was found.
    [[noreturn]] void fail(const std::string& expected) const;

private:
    const std::string* file_;
    std::size_t line_;
    std::vector<std::string_view> words_;
};

/// The entities of one file, comments left out.
class MgfFile {
public:
    /// `nameInScene`: relative to the folder of the scene. Throws InputError if the file cannot be read.
    MgfFile(const std::filesystem::path& path, std::filesystem::path nameInScene);

    const std::string& name() const { return name_; } //!< for messages
    const std::filesystem::path& nameInScene() const { return nameInScene_; }
    std::size_t size() const { return lines_.size(); }
    MgfEntity entity(std::size_t k) const;
    std::string place(std::size_t line) const; //!< as MgfEntity::place

private:
    struct Line {
        std::size_t number, begin, length;
    };
    void joinContinuedLines();
    void findEntities();

    std::string name_;
    std::filesystem::path nameInScene_;
    std::string text_;
    std::vector<Line> lines_;
};

/// By its extension, whatever the case of its letters.
bool isMgf(const std::filesystem::path& path);

/// The MGF file at `path` and all that it includes, each once. Files that cannot be read are listed, but not searched.
std::vector<std::filesystem::path> filesOfMgf(const std::filesystem::path& path);

/// The file that the entity `i` names, relative to the scene's folder.
std::filesystem::path includedName(const MgfFile& includer, const MgfEntity& include);

} // namespace lambert
