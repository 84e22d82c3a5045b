#include "hostile_file.h"

#include "sound_scene.h"

#include "comparison/compare_bakes.h"
#include "core/error.h"
#include "meshing/build_patch_mesh.h"
#include "meshing/prepare.h"
#include "scene/rays/ray_caster.h"
#include "scene/reading/scene_reader.h"
#include "solver/solution_file.h"

#include <glm/geometric.hpp>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#ifdef LAMBERT_SANITIZED
/// Debian's OpenImageIO 2.4 leaves its PNG reader by longjmp and with it a message of some bytes, once per broken file.
extern "C" const char* __lsan_default_suppressions() { return "leak:ImageInput::geterror"; }
#endif

namespace lambert {

namespace {

// So that one input takes milliseconds. What larger scenes do is for tests with a clock: scripts/campaign.py.
constexpr std::size_t kMostPolygons = 100;
constexpr std::size_t kMostStarts = 32; // of rays, 8 each

/// A folder in memory for the files of this process.
class ScratchFolder {
public:
    ScratchFolder() {
        std::error_code error;
        const std::filesystem::path memory = "/dev/shm";
        const auto parent = ::access(memory.c_str(), W_OK) == 0 ? memory : std::filesystem::temp_directory_path(error);
        path_ = parent / ("lambert-fuzz-" + std::to_string(::getpid()));
        std::filesystem::create_directories(path_);
    }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    std::filesystem::path write(const std::string& name, std::string_view content) const {
        const std::filesystem::path file = path_ / name;
        std::ofstream(file, std::ios::binary).write(content.data(), static_cast<std::streamsize>(content.size()));
        return file;
    }
    void remove(const std::string& name) const { std::filesystem::remove(path_ / name); }

private:
    std::filesystem::path path_;
};

std::string companionOf(std::string_view format) {
    if (format == "obj") return "scene.mtl";
    if (format == "gltf") return "scene.bin";
    if (format == "mgf") return "scene.inc";
    return {};
}

/// Rays to the eight octants from a little above the polygons' centres.
void castRays(const Scene& scene, const RayCaster& rays, const PatchMesh& mesh) {
    const std::size_t step = scene.polygons.size() / kMostStarts + 1;
    for (std::size_t p = 0; p < scene.polygons.size(); p += step) {
        const glm::vec3 centre = polygonPoint(scene, static_cast<std::uint32_t>(p), 0.3F, 0.3F);
        const glm::vec3 normal(glm::normalize(glm::dvec3(areaVector(scene, scene.polygons[p]))));
        const glm::vec3 origin = centre + rays.originOffset(rays.bounds().diagonal()) * normal;
        for (unsigned octant = 0; octant < 8; ++octant) {
            const auto sign = [&](unsigned bit) { return (octant >> bit & 1U) != 0 ? 1.0F : -1.0F; };
            const Ray ray{origin, {sign(0), 0.7F * sign(1), 0.4F * sign(2)}};
            if (const std::optional<Hit> hit = rays.closest(ray)) requireSoundHit(scene, mesh, *hit);
            rays.occluded(ray);
        }
    }
}

void takeThrough(const Scene& read) {
    requireSoundScene(read);
    if (read.polygons.size() > kMostPolygons) return;
    const Scene scene = prepareScene(read);
    if (scene.polygons.empty()) return;
    requireSoundScene(scene);
    const RayCaster rays(scene);
    Progress progress;
    for (const std::size_t patches : {std::size_t{0}, 2 * kMostPolygons}) {
        const PatchMesh mesh = buildPatchMesh(scene, {.patchLength = {}, .patches = patches}, progress);
        requireSoundMesh(scene, mesh);
        castRays(scene, rays, mesh);
    }
}

void readScene(const ScratchFolder& folder, std::string_view format, std::string_view input) {
    if (const std::string companion = companionOf(format); !companion.empty()) {
        const std::size_t mark = input.find(kCompanionMark);
        if (mark != std::string_view::npos) {
            folder.write(companion, input.substr(mark + kCompanionMark.size()));
            input = input.substr(0, mark + 1);
        } else {
            folder.remove(companion);
        }
    }
    ReadOptions options;
    options.strict = input.size() % 2 == 1;
    options.twoSided = input.size() % 4 >= 2;
    takeThrough(lambert::readScene(folder.write("scene." + std::string(format), input), options).scene);
}

void readImage(const ScratchFolder& folder, std::string_view input) {
    constexpr std::array kContents{TextureContent::Colour, TextureContent::GreyAlpha, TextureContent::Linear};
    const TextureContent content = kContents[input.size() % kContents.size()];
    const std::span bytes(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
    // A wrong extension is forgiven, so that this name stands for every format.
    const auto file = folder.write("image.png", input);
    for (const bool inMemory : {true, false}) {
        try {
            requireSoundTexture(*(inMemory ? readTexture(bytes, "image", content) : readTexture(file, content)));
        } catch (const InputError&) {
            continue;
        }
    }
}

/// What was read can be shown, compared, and written again: then it reads as the same.
void readSolutionFile(const ScratchFolder& folder, std::string_view input) {
    const StoredSolution solution = readSolution(folder.write("solution.glb", input));
    const Scene& scene = *solution.meshed.scene;
    if (!scene.polygons.empty()) RayCaster(scene).bounds();
    const SolutionRecord record{
        scene,           solution.meshed.mesh, solution.meshed.optics, solution.solution, solution.standardError,
        solution.origin, "of a test"};
    const auto again = folder.write("again.glb", {});
    writeSolution(record, again);
    const BakeComparison comparison = compareBakes(solution, readSolution(again), Quantity::Radiosity);
    require(comparison.samePatches && !(comparison.overall.maximum > 0.0), "a solution is written as it was read");
}

} // namespace

void readHostileFile(std::string_view format, std::string_view input) {
    static const ScratchFolder folder;
    try {
        if (format == "image")
            readImage(folder, input);
        else if (format == "solution")
            readSolutionFile(folder, input);
        else
            readScene(folder, format, input);
    } catch (const InputError& error) {
        require(error.what()[0] != '\0', "an InputError says why");
    }
}

} // namespace lambert
