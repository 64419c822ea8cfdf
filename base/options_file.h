// The bytes of a small text file that a user named.
#pragma once

#include <string>

namespace trocar {

inline constexpr std::size_t max_options_bytes = std::size_t{16} << 20;

// Throws InputError unless it is a regular file of 1 byte to max_options_bytes that can be read;
// never blocks.
std::string read_options_file(const std::string& file);

}  // namespace trocar
