#pragma once

#include <cstdint>

namespace lambert {

/// Memory of this process that is resident now, in bytes; 0 if unknown.
std::uint64_t residentMemoryBytes();

/// Largest resident memory of this process, in bytes: since the last resetPeakMemory(), or since its start.
std::uint64_t peakMemoryBytes();

/// Returns freed memory to the system and starts the peak afresh, so that the next one is that of the work to come. False
/// where the system does not allow it: the old peak stays.
bool resetPeakMemory();

/// From now on, freed blocks of a mebibyte and more go back to the system at once. By itself the C library raises that bound
/// to the largest block ever freed, and memory then peaks a fifth higher.
void returnLargeBlocks();

/// Gives back to the system what was freed in small pieces, of all threads. Takes milliseconds: for after work that used much of it.
void returnFreedMemory();

/// Processor time that this process has taken since its start, all threads and the system's work for them, in seconds.
double processorSeconds();

} // namespace lambert
