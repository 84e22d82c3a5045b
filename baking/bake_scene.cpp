#include "baking/bake_scene.h"

#include "core/stopwatch.h"

#include <utility>

namespace lambert {

BakedScene bakeScene(const Scene& scene, const BakeOptions& options, Progress& progress) {
    std::vector<BakedLight> lights;
    LightSink sink;
    if (options.perLight)
        sink = [&](SolvedLight light, const SolvedScene& solved) {
            lights.push_back(bakeLight(solved, std::move(light), options.reconstruction, options.gather, progress));
        };
    BakedScene result{solveScene(scene, options.solve, progress, sink)};
    result.lights = std::move(lights);

    const Stopwatch watch;
    const LitPatches lit = litPatches(result);
    if (options.gather) {
        result.baked = reconstructGather(lit, *result.rays, lightsOf(*result.scene), options.reconstruction,
                                         *options.gather, progress, &result.gather.emplace(), &result.separatedFaces);
    } else {
        progress.begin("bake", 0);
        result.baked = reconstructAverage(lit, options.reconstruction, &result.separatedFaces);
        progress.end();
    }
    result.bakeSeconds = watch.seconds();
    return result;
}

} // namespace lambert
