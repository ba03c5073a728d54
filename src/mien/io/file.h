#pragma once
/// Whole files in and out.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace mien {

/// All bytes of a regular file.
///   throws  io: it does not exist, is a folder, cannot be read
std::vector<std::uint8_t> read_file(const std::filesystem::path& path);

/// Writes under a temporary name in the same folder, flushes to the disk, then renames: the file appears
/// whole or not at all, and an older file of that name stays until the new one is complete.
///   throws  io: the folder does not exist or cannot be written to, the disk is full; nothing is left behind
void write_file_atomically(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
void write_file_atomically(const std::filesystem::path& path, std::string_view text);

}  // namespace mien
