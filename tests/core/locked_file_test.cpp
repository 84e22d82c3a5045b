#include "core/locked_file.h"

#include "core/error.h"
#include "tests/core/temporary_folder.h"

#include <gtest/gtest.h>

#include <unistd.h>

namespace lambert {
namespace {

TEST(LockedFile, IsOpenOnlyOnceAtATime) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.write("file", "content");
    {
        const LockedFile first(path, path);
        EXPECT_THROW(LockedFile(path, path), UsageError);
        char byte = 0;
        EXPECT_EQ(::pread(first.descriptor(), &byte, 1, 0), 1);
        EXPECT_EQ(byte, 'c');
    }
    const LockedFile next(path, path);
}

// Who waits for the first one's end must not hold what has no name, or a third one could hold the name.
TEST(LockedFile, ThatIsRemovedLocksNothingElse) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "file";
    LockedFile first(path, path);
    first.remove();
    EXPECT_FALSE(std::filesystem::exists(path));
    const LockedFile second(path, path);
    EXPECT_TRUE(std::filesystem::exists(path));
    EXPECT_THROW(LockedFile(path, path), UsageError);
}

TEST(LockedFile, NamesPathAndReasonIfItCannotBeOpened) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "missing" / "file";
    try {
        const LockedFile file(path, path);
        FAIL();
    } catch (const SystemError& error) {
        EXPECT_EQ(std::string(error.what()),
                  path.string() + ": cannot write the checkpoint: No such file or directory");
    }
}

} // namespace
} // namespace lambert
