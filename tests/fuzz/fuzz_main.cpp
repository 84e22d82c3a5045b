#include "hostile_file.h"

#include "core/parallel.h"

#include <cstddef>
#include <cstdint>

/// libFuzzer's way in; LAMBERT_FUZZ_FORMAT is the format that this program fuzzes.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    lambert::setThreadCount(1); // an input must do the same each time
    lambert::readHostileFile(LAMBERT_FUZZ_FORMAT, {reinterpret_cast<const char*>(data), size});
    return 0;
}
