// A file read whole into memory and written whole: a reader never sees half a file, because a
// writer fills a temporary one and renames it.
#pragma once

#include <limits>
#include <string>
#include <string_view>

namespace trocar {

// Why it can't be read, as far as can be told without opening it: "" if it is a regular file.
std::string fault_of_file(const std::string& file);

// Throws InputError unless it is a regular file of 1 to most_bytes bytes (in messages of whole MB),
// MachineError if reading fails. Never blocks.
std::string read_whole_file(const std::string& file,
                            std::size_t most_bytes = std::numeric_limits<std::size_t>::max());

// Replaces the file, of a link the one that it leads to; writes into a device or a pipe. Throws
// MachineError with path and reason; what was there before is then untouched.
void write_whole_file(const std::string& file, std::string_view content);

}  // namespace trocar
