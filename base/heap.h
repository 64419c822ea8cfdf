// How the program's memory is kept, how much it was and may become.
#pragma once

#include <cstdint>

namespace trocar {

// Memory that was freed stays with the process, up to 256 MB of it, in place of going back to the
// system and coming again page by page: an edit of 60,000 tetrahedra took twice as long
// (bench_edit --thin 15 2000). For programs, at their start.
void keep_freed_memory();

// The most memory that the process has had at a time: its resident set, libraries and all.
std::int64_t peak_memory_bytes();

// What the machine can still give, and its control group (version 2) of this process; infinite
// where neither is known. [bytes]
double memory_of_host();
// What limits of this process (ulimit) leave it; infinite without any. [bytes]
double memory_of_process();

}  // namespace trocar
