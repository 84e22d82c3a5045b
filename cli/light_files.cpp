#include "cli/light_files.h"
#include "cli/bake_report.h"
#include "cli/targets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

namespace lambert {

namespace fs = std::filesystem;

namespace {

std::string fileName(const std::string& light) {
    std::string name = light.empty() ? "unnamed" : light;
    for (char& c : name) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x80 && std::isalnum(byte) == 0 && c != '-') c = '_';
    }
    return name;
}

} // namespace

fs::path lightFile(const fs::path& output, const std::string& light) {
    const std::string name = output.stem().string() + ".light-" + fileName(light) + output.extension().string();
    return fs::path(output).replace_filename(name);
}

std::vector<WrittenLight> writeLights(const BakedScene& baked, std::span<const BakeJob::Output> outputs,
                                      const BakeOutputOptions& options, std::span<const fs::path> inputs) {
    std::vector<WrittenLight> written;
    std::vector<fs::path> targets;
    std::set<std::string> taken;
    for (const BakedLight& light : baked.lights) {
        std::string name = light.group.name;
        for (int k = 2; !taken.insert(fileName(name)).second; ++k) name = fmt::format("{} {}", light.group.name, k);
        WrittenLight& entry = written.emplace_back(WrittenLight{&light, {}});
        for (const BakeJob::Output& output : outputs) {
            entry.files.push_back(lightFile(output.path, name));
            targets.push_back(entry.files.back());
        }
    }
    checkTargets(targets, inputs);
    for (const WrittenLight& entry : written)
        for (std::size_t k = 0; k < outputs.size(); ++k)
            writeBaked(withLight(baked.baked, *entry.light, options.quantity), entry.files[k], outputs[k].format,
                       options);
    return written;
}

nlohmann::ordered_json lightsJson(std::span<const WrittenLight> lights) {
    using Json = nlohmann::ordered_json;
    Json json = Json::array();
    for (const WrittenLight& entry : lights) {
        Json files = Json::array();
        for (const fs::path& file : entry.files) files.push_back(file.string());
        json.push_back({{"name", entry.light->group.name},
                        {"kind", nameOf(entry.light->group.kind)},
                        {"files", files},
                        {"iterations", entry.light->iterations},
                        {"residual", entry.light->residual},
                        {"energy", energyJson(entry.light->energy)}});
    }
    return json;
}

} // namespace lambert
