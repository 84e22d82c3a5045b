#include "core/whole_file.h"

#include "core/error.h"
#include "tests/core/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace lambert {
namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::vector<std::string> namesIn(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

bool isTemporary(const std::string& name) { return name.starts_with(".lambert-") && name.ends_with(".tmp"); }

/// So many that the last ones have temporary names: more than are kept open without names.
constexpr std::size_t kMany = 258;

/// `kMany` files "0", "1", ... whose content is `prefix` and their number, with `during` called while the last one is written.
std::vector<FileStream> manyFiles(const fs::path& folder, const std::string& prefix,
                                  const std::function<void()>& during) {
    std::vector<FileStream> files;
    for (std::size_t k = 0; k < kMany; ++k)
        files.push_back({folder / std::to_string(k), [=](std::ostream& stream) {
                             stream << prefix << k << std::flush;
                             if (k == kMany - 1) during();
                         }});
    return files;
}

std::string failureOf(const std::function<void()>& action) {
    try {
        action();
    } catch (const SystemError& error) {
        return error.what();
    }
    ADD_FAILURE() << "no SystemError";
    return {};
}

TEST(WriteWholeFile, WritesTheContentAndNothingElse) {
    const TemporaryFolder folder;
    const std::string content("zero \0 and line ends \r\n\n stay", 28);
    writeWholeFile(folder.path() / "new.bin", content);
    EXPECT_EQ(contentOf(folder.path() / "new.bin"), content);
    writeWholeFile(folder.path() / "empty", "");
    EXPECT_EQ(fs::file_size(folder.path() / "empty"), 0U);
    const std::string large(3'000'001, 'x');
    writeWholeFile(folder.path() / "large", large);
    EXPECT_EQ(contentOf(folder.path() / "large"), large);
    EXPECT_EQ(namesIn(folder.path()), (std::vector<std::string>{"empty", "large", "new.bin"}));
}

TEST(WriteWholeFile, ReplacesAnOldFile) {
    const TemporaryFolder folder;
    const fs::path file = folder.write("result.csv", "an old and longer content");
    writeWholeFile(file, "new");
    EXPECT_EQ(contentOf(file), "new");
    EXPECT_EQ(namesIn(folder.path()), std::vector<std::string>{"result.csv"});
}

bool hasNamelessFiles(const fs::path& folder) {
    const int file = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
    if (file >= 0) ::close(file);
    return file >= 0;
}

// A process can be killed at any moment: then the old content is still there, and beside it nothing, or on file systems that
// know only files with names the temporary one.
TEST(WriteWholeFile, HasNoNameUntilItIsWhole) {
    const TemporaryFolder folder;
    const fs::path file = folder.write("result.csv", "old");
    const std::ptrdiff_t expected = hasNamelessFiles(folder.path()) ? 0 : 1;
    writeWholeFile(file, [&](std::ostream& stream) {
        stream << "half of the new content" << std::flush;
        const std::vector<std::string> names = namesIn(folder.path());
        EXPECT_EQ(std::count_if(names.begin(), names.end(), isTemporary), expected);
        EXPECT_EQ(names.size(), static_cast<std::size_t>(1 + expected));
        EXPECT_EQ(contentOf(file), "old");
    });
    EXPECT_EQ(contentOf(file), "half of the new content");
    EXPECT_EQ(namesIn(folder.path()), std::vector<std::string>{"result.csv"});
}

// Of the temporary names that the last files have meanwhile none is left.
TEST(WriteWholeFiles, AlsoWithTemporaryNames) {
    const TemporaryFolder folder;
    bool temporary = false;
    writeWholeFiles(manyFiles(folder.path(), "", [&] {
        const std::vector<std::string> names = namesIn(folder.path());
        temporary = std::any_of(names.begin(), names.end(), isTemporary);
    }));
    EXPECT_TRUE(temporary);
    EXPECT_EQ(namesIn(folder.path()).size(), kMany);
    for (std::size_t k = 0; k < kMany; ++k) EXPECT_EQ(contentOf(folder.path() / std::to_string(k)), std::to_string(k));
}

// As two processes of one number do on machines that share a folder: each file gets its own content, not the other's.
TEST(WriteWholeFiles, KeepApartWhatIsWrittenAtOneTimeToOneFolder) {
    const TemporaryFolder folder;
    writeWholeFiles(manyFiles(folder.path(), "outer ", [&] {
        std::vector<FileStream> inner = manyFiles(folder.path(), "inner ", [] {});
        for (FileStream& file : inner) file.path += " too";
        writeWholeFiles(inner);
    }));
    for (std::size_t k = 0; k < kMany; ++k) {
        const std::string name = std::to_string(k);
        EXPECT_EQ(contentOf(folder.path() / name), "outer " + name);
        EXPECT_EQ(contentOf(folder.path() / (name + " too")), "inner " + name);
    }
    EXPECT_EQ(namesIn(folder.path()).size(), 2 * kMany);
}

TEST(WriteWholeFile, HasThePermissionsOfAnyNewFile) {
    const TemporaryFolder folder;
    const ::mode_t before = ::umask(027);
    writeWholeFile(folder.path() / "result.csv", "new");
    ::umask(before);
    EXPECT_EQ(fs::status(folder.path() / "result.csv").permissions(), static_cast<fs::perms>(0640));
}

TEST(WriteWholeFiles, ReplacesAllOrNone) {
    const TemporaryFolder folder;
    const fs::path first = folder.write("first", "old");
    const fs::path second = folder.write("second", "old");
    const FileContent missing{folder.path() / "missing" / "third", "new"};
    failureOf([&] { writeWholeFiles(std::array{FileContent{first, "new"}, FileContent{second, "new"}, missing}); });
    EXPECT_EQ(contentOf(first), "old");
    EXPECT_EQ(contentOf(second), "old");
    EXPECT_EQ(namesIn(folder.path()), (std::vector<std::string>{"first", "second"}));

    writeWholeFiles(std::array{FileContent{first, "new"}, FileContent{second, "newer"}});
    EXPECT_EQ(contentOf(first), "new");
    EXPECT_EQ(contentOf(second), "newer");
    EXPECT_EQ(namesIn(folder.path()), (std::vector<std::string>{"first", "second"}));
}

TEST(WriteWholeFile, NamesPathAndReasonIfTheFolderIsMissing) {
    const TemporaryFolder folder;
    const fs::path file = folder.path() / "missing" / "a.txt";
    const std::string message = failureOf([&] { writeWholeFile(file, "content"); });
    EXPECT_NE(message.find(file.string()), std::string::npos) << message;
    EXPECT_NE(message.find("No such file"), std::string::npos) << message;
    EXPECT_TRUE(namesIn(folder.path()).empty());
}

TEST(WriteWholeFile, DoesNotReplaceAFolder) {
    const TemporaryFolder folder;
    folder.write("target/inside.txt", "kept");
    const std::string message = failureOf([&] { writeWholeFile(folder.path() / "target", "content"); });
    EXPECT_NE(message.find("irectory"), std::string::npos) << message;
    EXPECT_EQ(contentOf(folder.path() / "target" / "inside.txt"), "kept");
    EXPECT_EQ(namesIn(folder.path()), std::vector<std::string>{"target"});
}

TEST(WriteWholeFile, AcceptsANameWithoutFolderAndOddNames) {
    const TemporaryFolder folder;
    const fs::path before = fs::current_path();
    fs::current_path(folder.path());
    writeWholeFile("plain.txt", "a");
    writeWholeFile(".hidden", "b");
    writeWholeFile("with space", "c");
    fs::current_path(before);
    EXPECT_EQ(namesIn(folder.path()), (std::vector<std::string>{".hidden", "plain.txt", "with space"}));
}

TEST(RequireWritable, AcceptsNewAndOldFiles) {
    const TemporaryFolder folder;
    requireWritable(folder.path() / "new.txt");
    requireWritable(folder.write("old.txt", "kept"));
    requireWritable("in_the_current_folder.txt");
    EXPECT_EQ(contentOf(folder.path() / "old.txt"), "kept");
    EXPECT_EQ(namesIn(folder.path()), std::vector<std::string>{"old.txt"});
}

TEST(RequireWritable, RefusesFoldersAndMissingFolders) {
    const TemporaryFolder folder;
    EXPECT_NE(failureOf([&] { requireWritable(folder.path()); }).find(folder.path().string()), std::string::npos);
    failureOf([&] { requireWritable(folder.path() / "missing" / "a.txt"); });
    folder.write("file", "");
    failureOf([&] { requireWritable(folder.path() / "file" / "a.txt"); });
}

TEST(RequireWritable, RefusesAFolderWithoutPermission) {
    if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
    const TemporaryFolder folder;
    fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
    failureOf([&] { requireWritable(folder.path() / "a.txt"); });
    failureOf([&] { writeWholeFile(folder.path() / "a.txt", "content"); });
    fs::permissions(folder.path(), fs::perms::owner_all);
}

} // namespace
} // namespace lambert
