#pragma once

/// Put before a function whose loops run over 16 lanes: compiles it for AVX-512, AVX2 and the baseline, and picks
/// the best at load time, so that one binary is fast everywhere. Off under sanitizers, which resolve too late.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) &&               \
    !defined(__SANITIZE_THREAD__)
#define LAMBERT_VECTOR_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define LAMBERT_VECTOR_CLONES
#endif
