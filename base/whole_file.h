// A file read whole into memory and written whole: a reader never sees half a file, because a
// writer fills a temporary one and renames it.
#pragma once

#include <string>
#include <string_view>

namespace trocar {

// Why it can't be read, as far as can be told without opening it: "" if it is a regular file.
std::string fault_of_file(const std::string& file);

// Throws InputError if there is no such file, it is empty or it is not a regular file (a pipe would
// hang), MachineError if reading fails.
std::string read_whole_file(const std::string& file);

// Replaces the file, of a link the one that it leads to; writes into a device or a pipe. Throws
// MachineError with path and reason; what was there before is then untouched.
void write_whole_file(const std::string& file, std::string_view content);

}  // namespace trocar
