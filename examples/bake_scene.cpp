/// bake_scene SCENE OUT: writes what `lambert bake SCENE -o OUT` writes, and says how bright the scene is.
#include <lambert/lambert.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace {

/// One line on a terminal, overwritten as the work goes on.
bool showProgress(std::string_view stage, double done) {
    std::fprintf(stderr, "\r%-24.*s %3.0f %%", static_cast<int>(stage.size()), stage.data(), 100.0 * done);
    return true;
}

void sayAll(const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) std::fprintf(stderr, "\rwarning: %s\n", warning.c_str());
}

} // namespace

int main(int count, char** arguments) {
    namespace library = lambert::library;
    if (count != 3) {
        std::fprintf(stderr, "bake_scene SCENE OUT   (Lambert %s)\n", std::string(library::version()).c_str());
        return 2;
    }
    try {
        const library::Scene scene = library::readScene(arguments[1]);
        sayAll(scene.warnings());
        const library::Bake bake = library::bake(scene, {.progress = showProgress});
        sayAll(bake.warnings());
        library::write(bake, arguments[2]);

        const auto radiosity = bake.radiosity();
        const float brightest = radiosity.empty() ? 0.0F : *std::max_element(radiosity.begin(), radiosity.end());
        std::printf("\r%zu polygons, %zu patches, %zu vertices, at most %.4g per m2, energy imbalance %.2g\n",
                    scene.polygons(), bake.faces().size() / 4, bake.positions().size() / 3,
                    static_cast<double>(brightest), bake.imbalance());
    } catch (const std::exception& failure) {
        std::fprintf(stderr, "\rbake_scene: %s\n", failure.what());
        return 1;
    }
    return 0;
}
