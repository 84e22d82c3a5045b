/// at_once SCENE...: bakes the scenes one after another and then all at once, each with a number of threads of its own; they must be alike.
#include <lambert/lambert.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <thread>
#include <vector>

namespace {

std::vector<float> lightOf(const char* path, int threads) {
    const lambert::library::Bake bake = lambert::library::bake(
        lambert::library::readScene(path), {.quality = "preview", .patches = 300, .threads = threads});
    return {bake.irradiance().begin(), bake.irradiance().end()};
}

} // namespace

int main(int count, char** arguments) {
    const std::vector<const char*> scenes(arguments + 1, arguments + count);
    std::vector<std::vector<float>> alone, together(scenes.size());
    for (const char* scene : scenes) alone.push_back(lightOf(scene, 0));
    std::vector<std::thread> threads;
    for (std::size_t k = 0; k < scenes.size(); ++k)
        threads.emplace_back([&, k] { together[k] = lightOf(scenes[k], static_cast<int>(k) + 1); });
    for (std::thread& thread : threads) thread.join();
    for (std::size_t k = 0; k < scenes.size(); ++k)
        if (alone[k].empty() || alone[k] != together[k]) {
            std::fprintf(stderr, "%s differs\n", scenes[k]);
            return 1;
        }
    try {
        lightOf(scenes.front(), -1);
    } catch (const lambert::library::Failure& failure) {
        return failure.kind() == lambert::library::Failure::Kind::Setting ? 0 : 1;
    }
    return 1;
}
