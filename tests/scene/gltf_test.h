#pragma once

#include "gltf_square.h"
#include "reader_checks.h"
#include "tests/core/temporary_folder.h"

namespace lambert {

/// Reads squares that a test has changed.
class GltfTest : public testing::Test {
protected:
    ReadResult read(const Square& square, const ReadOptions& options = {}) {
        return readScene(folder.write("scene.glb", glb(square.document, square.binary)), options);
    }
    void expectError(const Square& square, const std::string& part) {
        SCOPED_TRACE(part);
        expectInputError(folder.write("scene.glb", glb(square.document, square.binary)), part);
    }
    /// Expects the error that the square gives after `change` was merged into it at `pointer`.
    void expectErrorAt(const std::string& pointer, const std::string& value, const std::string& part) {
        Square square;
        square[pointer] = nlohmann::json::parse(value);
        expectError(square, part);
    }

    TemporaryFolder folder;
};

} // namespace lambert
