#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#define LAMBERT_API __attribute__((visibility("default")))

/// Lambert as a library, in five calls: readScene, bake, write, formFactors, version.
///
/// What holds for all of them:
/// - Units: metres; radiosity and irradiance per m², colours linear RGB of the Rec. 709 primaries; whether they are watts or lumens is
///   the scene's choice.
/// - Arrays are flat: three numbers per vertex or colour, so that they go to any other library as they are.
/// - The same files, settings and version give the same bits, whatever the number of processors.
/// - Errors are Failure: one line for the person who gave the file or the number, as the program `lambert` prints it. Nothing is
///   half-written then. Want of memory beyond what Lambert plans for is std::bad_alloc.
/// - Several threads may call at once. Results are values: copies share what they hold, and may be read from any thread.
namespace lambert::library {

/// Why a call ended without a result.
class LAMBERT_API Failure : public std::runtime_error {
public:
    enum class Kind { Setting, Input, System, Stopped }; ///< a setting, a file, memory or disk, by `progress`
    Failure(Kind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
    Kind kind() const { return kind_; }

private:
    Kind kind_;
};

/// Of the library that is loaded, such as "0.1.0".
LAMBERT_API std::string_view version();

/// Told the stage and how much of it is done, 0 to 1; returns false to stop. Called from any thread, some hundred times per stage at
/// most.
using OnProgress = std::function<bool(std::string_view stage, double done)>;

struct ReadSettings {
    std::optional<double> metresPerUnit; //!< above 0; none: what the file beside the scene says, or 1; of glTF always 1
    bool twoSided = false;               //!< every surface reflects and emits on both sides
    bool overrides = true; //!< heeds changes in a file beside the scene, ROOM.lambert.json beside ROOM.obj
};

/// A scene that was read.
class LAMBERT_API Scene {
public:
    std::size_t polygons() const;
    std::vector<std::string> materials() const;       //!< names, as FormFactors::material counts them
    const std::vector<std::string>& warnings() const; //!< what was changed or left out, one line each

    struct Content;
    explicit Scene(std::shared_ptr<const Content> content) : content_(std::move(content)) {}
    const Content& content() const { return *content_; }

private:
    std::shared_ptr<const Content> content_;
};

/// Reads a .gltf, .glb, .obj, .ply, .stl or .mgf file.
LAMBERT_API Scene readScene(const std::filesystem::path& path, const ReadSettings& settings = {});

struct BakeSettings {
    std::string quality = "normal";     //!< preview, normal or high
    std::optional<std::size_t> patches; //!< about so many; 0: one per polygon of the file; none: as the quality has it
    std::uint64_t seed = 1;
    int threads = 0; //!< that work, the calling one included; 0: as many as there are processors
    OnProgress progress{};
};

/// The light at the vertices of a scene's patches.
class LAMBERT_API Bake {
public:
    std::span<const float> positions() const;  //!< 3 · #vertices, relative to origin()
    std::span<const float> normals() const;    //!< 3 · #vertices, unit length
    std::span<const float> radiosity() const;  //!< 3 · #vertices, >= 0: what leaves the surface
    std::span<const float> irradiance() const; //!< 3 · #vertices, >= 0: what falls on it
    std::span<const std::uint32_t>
    faces() const;                      //!< 4 · #patches, vertices counter-clockwise; a triangle ends in 0xFFFFFFFF
    std::vector<double> origin() const; //!< 3: the file's place of 0 0 0
    double imbalance() const;           //!< of energy, a share: what the form factors lost, below 0: made
    const std::vector<std::string>& warnings() const; //!< what makes the result worse than it looks, one line each

    struct Content;
    explicit Bake(std::shared_ptr<const Content> content) : content_(std::move(content)) {}
    const Content& content() const { return *content_; }

private:
    std::shared_ptr<const Content> content_;
};

/// Solves for the light of all bounces, as `lambert bake` does without options.
LAMBERT_API Bake bake(const Scene& scene, const BakeSettings& settings = {});

/// Writes vertex colours as .glb, .gltf, .ply or .obj: the bytes that `lambert bake SCENE -o PATH` writes. The file appears whole.
LAMBERT_API void write(const Bake& bake, const std::filesystem::path& path);

/// The share of the light leaving patch i that reaches patch j, by rows: patches column[k], factors value[k] for k from row[i] to
/// row[i + 1]. With what meets black backs and what leaves the scene each row sums to 1 within `error[i]`.
struct FormFactors {
    std::vector<std::size_t> row; //!< #patches + 1
    std::vector<std::uint32_t> column;
    std::vector<double> value;
    std::vector<double> area;            //!< #patches, m²
    std::vector<double> back, out;       //!< #patches
    std::vector<double> error;           //!< #patches, of the row: Σ_j |ΔF_ij| as the method knows it
    std::vector<std::uint32_t> material; //!< #patches, see Scene::materials
};

/// The form factors of the scene's patches, as `lambert formfactors` computes them without options.
LAMBERT_API FormFactors formFactors(const Scene& scene, const BakeSettings& settings = {});

} // namespace lambert::library
