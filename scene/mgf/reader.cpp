// The Materials and Geometry Format: G. Ward, Lawrence Berkeley National Laboratory, versions 1.0 (May 1995) to 2.0.

#include "core/error.h"
#include "core/progress.h"
#include "core/text.h"
#include "scene/mgf/contexts.h"
#include "scene/mgf/file.h"
#include "scene/mgf/geometry.h"
#include "scene/mgf/transform.h"
#include "scene/named_file.h"
#include "scene/readers.h"
#include "scene/scene_builder.h"
#include "scene/words.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>

namespace lambert {

namespace {

// Arrays and includes repeat what a small file says; these end it long before memory or patience do.
constexpr std::size_t kMaxEntities = 30'000'000;
constexpr std::size_t kMaxIncludes = 100'000;
constexpr std::size_t kMaxIncludeDepth = 64;
constexpr std::size_t kMaxNesting = 256;
constexpr std::size_t kMaxNodeName = 4096;
constexpr std::size_t kMaxUnknownNamed = 10;

/// An `xf` that has not ended, or an include's transform.
struct OpenTransform {
    MgfTransform transform;
    glm::dmat4 outer;        //!< in force around it
    std::uint64_t instances; //!< with the arrays around it
    std::size_t body;        //!< the first entity inside
    std::size_t line;
    std::uint64_t instance = 0;
};

class MgfReader {
public:
    MgfReader(const std::filesystem::path& path, const ReadOptions& options)
        : folder_(path.parent_path()),
          options_(options),
          builder_(path.string(), options),
          geometry_(builder_, contexts_, options.curveSegments) {
        setTransform(glm::scale(glm::dmat4(1.0), glm::dvec3(options.metresPerUnit)));
    }

    ReadResult run(const std::filesystem::path& path) {
        readFile(*readOnce(path, path.filename()));
        geometry_.warnAboutMaterials();
        if (unknown_.size() > kMaxUnknownNamed)
            builder_.warn(fmt::format("{} more unknown entities were ignored", unknown_.size() - kMaxUnknownNamed));
        if (luminaires_ > 0)
            builder_.warn(
                fmt::format("{} luminaires (ies) were ignored, the first in {}", luminaires_, firstLuminaire_));
        return builder_.finish();
    }

private:
    /// What was open when a file began: it may end only what it began itself.
    struct Scope {
        std::size_t transforms = 0, objects = 0;
    };

    void readFile(const MgfFile& file) {
        includes_.push_back(&file);
        const Scope around = std::exchange(scope_, {transforms_.size(), objects_.size()});
        for (std::size_t next = 0; next < file.size();) next = execute(file, next);
        closeWhatIsOpen(file);
        scope_ = around;
        includes_.pop_back();
    }

    void closeWhatIsOpen(const MgfFile& file) {
        while (transforms_.size() > scope_.transforms) {
            const OpenTransform& open = transforms_.back();
            if (open.transform.isArray())
                failAt(file.name(), open.line, "xf with an array", "its end, an xf alone, in the same file");
            builder_.warn(fmt::format("the transform of {} has no end, an xf alone", file.place(open.line)));
            popTransform();
        }
        objects_.resize(scope_.objects);
        node_ = kNone;
    }

    /// Carries out an entity and returns the number of the next.
    std::size_t execute(const MgfFile& file, std::size_t k) {
        const MgfEntity entity = file.entity(k);
        const std::string_view keyword = entity.keyword();
        if (++entities_ > kMaxEntities)
            entity.fail(
                fmt::format("at most {} entities, those repeated by arrays and includes counted", kMaxEntities));
        if (entities_ % 4096 == 0) options_.progress->throwIfCancelled();

        if (contexts_.execute(entity)) return k + 1;
        if (MgfGeometry::isSurface(keyword)) {
            geometry_.setNode(node());
            geometry_.execute(entity);
        } else if (keyword == "xf" && entity.argumentCount() == 0) {
            return endTransform(entity, k);
        } else if (keyword == "xf") {
            beginTransform(entity, 0, k + 1);
        } else if (keyword == "o") {
            changeObject(entity);
        } else if (keyword == "i") {
            include(file, entity);
        } else if (keyword == "ies") {
            if (luminaires_++ == 0) firstLuminaire_ = entity.place();
        } else if (unknown_.insert(std::string(keyword)).second && unknown_.size() <= kMaxUnknownNamed) {
            builder_.warn(
                fmt::format("the entity {} is unknown and was ignored ({})", inQuotes(keyword), entity.place()));
        }
        return k + 1;
    }

    // ---- Transforms

    void beginTransform(const MgfEntity& entity, std::size_t firstArgument, std::size_t body) {
        MgfTransform transform(entity, firstArgument);
        if (transforms_.size() >= kMaxNesting) entity.fail(fmt::format("at most {} nested transforms", kMaxNesting));
        const std::uint64_t around = transforms_.empty() ? 1 : transforms_.back().instances;
        const std::uint64_t instances = around * transform.instances();
        if (instances > MgfTransform::kMaxInstances)
            entity.fail(fmt::format("at most {} instances, with the arrays around it", MgfTransform::kMaxInstances));
        transforms_.push_back({std::move(transform), toWorld_, instances, body, entity.line()});
        applyTransform();
    }

    std::size_t endTransform(const MgfEntity& entity, std::size_t k) {
        if (transforms_.size() == scope_.transforms) entity.fail("an xf with arguments before it in the same file");
        if (nextInstance()) return transforms_.back().body;
        popTransform();
        return k + 1;
    }

    bool nextInstance() {
        OpenTransform& open = transforms_.back();
        if (++open.instance == open.transform.instances()) return false;
        applyTransform();
        return true;
    }

    void applyTransform() {
        const OpenTransform& open = transforms_.back();
        setTransform(open.outer * open.transform.matrix(open.instance));
    }

    void popTransform() {
        setTransform(transforms_.back().outer);
        transforms_.pop_back();
    }

    void setTransform(const glm::dmat4& toWorld) {
        toWorld_ = toWorld;
        geometry_.setTransform(toWorld);
    }

    // ---- Objects

    void changeObject(const MgfEntity& entity) {
        entity.requireArguments(0, 1, "o NAME or o");
        node_ = kNone;
        if (entity.argumentCount() == 0) {
            if (objects_.size() == scope_.objects) entity.fail("an o with a name before it in the same file");
            objects_.pop_back();
            return;
        }
        if (objects_.size() >= kMaxNesting) entity.fail(fmt::format("at most {} nested objects", kMaxNesting));
        std::string name(entity.argument(0));
        if (!objects_.empty()) name = objects_.back() + "." + name;
        if (name.size() > kMaxNodeName) entity.fail(fmt::format("names of at most {} characters", kMaxNodeName));
        objects_.push_back(std::move(name));
    }

    /// The scene's index of the current object.
    std::uint32_t node() {
        if (node_ != kNone) return node_;
        const std::string name = objects_.empty() ? "default" : objects_.back();
        const auto [entry, isNew] = nodes_.try_emplace(name, kNone);
        if (isNew) entry->second = builder_.addNode(asUtf8(name));
        return node_ = entry->second;
    }

    // ---- Includes

    void include(const MgfFile& file, const MgfEntity& entity) {
        if (entity.argumentCount() == 0) entity.fail("i FILE, or i FILE TRANSFORM");
        const MgfFile& included = includedFile(file, entity);
        if (std::find(includes_.begin(), includes_.end(), &included) != includes_.end())
            entity.fail(entity.argument(0), "a file that does not include itself");
        if (includes_.size() > kMaxIncludeDepth) entity.fail(fmt::format("at most {} nested files", kMaxIncludeDepth));
        beginTransform(entity, 1, 0);
        do {
            if (++readings_ > kMaxIncludes) entity.fail(fmt::format("at most {} included files", kMaxIncludes));
            readFile(included);
        } while (nextInstance());
        popTransform();
    }

    const MgfFile& includedFile(const MgfFile& file, const MgfEntity& entity) {
        const std::filesystem::path name = includedName(file, entity);
        const auto [entry, isNew] = included_.try_emplace(name.string(), nullptr);
        if (!isNew) return *entry->second;
        try {
            entry->second = readOnce(namedFile(folder_, name.string(), options_), name);
        } catch (const InputError& error) {
            throw InputError(fmt::format("{}:{}: {}", entity.file(), entity.line(), error.what()));
        }
        return *entry->second;
    }

    /// The same file by another name is the same.
    const MgfFile* readOnce(const std::filesystem::path& path, const std::filesystem::path& nameInScene) {
        std::error_code error;
        auto& file = files_[std::filesystem::weakly_canonical(path, error).string()];
        if (!file) {
            file = std::make_unique<MgfFile>(path, nameInScene);
            if (!includes_.empty()) builder_.countBytes(std::filesystem::file_size(path, error));
        }
        return file.get();
    }

    std::filesystem::path folder_;
    const ReadOptions& options_;
    SceneBuilder builder_;
    MgfContexts contexts_;
    MgfGeometry geometry_;

    std::map<std::string, std::unique_ptr<MgfFile>> files_;
    std::map<std::string, const MgfFile*> included_; //!< by name in the scene
    std::vector<const MgfFile*> includes_;           //!< being read, each by the one before
    Scope scope_;                                    //!< of the last of them

    glm::dmat4 toWorld_{1.0};
    std::vector<OpenTransform> transforms_;
    std::vector<std::string> objects_; //!< names with those around them
    std::map<std::string, std::uint32_t> nodes_;
    std::uint32_t node_ = kNone; //!< of the current object, none before its first surface

    std::size_t entities_ = 0, readings_ = 0, luminaires_ = 0;
    std::string firstLuminaire_;
    std::set<std::string> unknown_;
};

} // namespace

ReadResult readMgf(const std::filesystem::path& path, const ReadOptions& options) {
    if (options.curveSegments < 4 || options.curveSegments > 1024 || options.curveSegments % 2 != 0)
        throw UsageError(
            fmt::format("--curve-segments: found {}, allowed are even numbers from 4 to 1024", options.curveSegments));
    return MgfReader(path, options).run(path);
}

} // namespace lambert
