#include "picture/image_module.h"

#include "core/error.h"

#include <dlfcn.h>
#include <fmt/format.h>

namespace lambert {

namespace {

ImageModule load() {
    // Looked for where the program's run path says, and never unloaded: the libraries behind it do not survive that.
    void* const library = dlopen(LAMBERT_IMAGE_MODULE, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (library == nullptr) throw SystemError(fmt::format("image files cannot be read or written: {}", dlerror()));
    void* const entry = dlsym(library, "lambertImageModule");
    if (entry == nullptr) throw SystemError(fmt::format("image files cannot be read or written: {}", dlerror()));
    return reinterpret_cast<ImageModule (*)()>(entry)();
}

} // namespace

const ImageModule& imageModule() {
    static const ImageModule module = load();
    return module;
}

} // namespace lambert
