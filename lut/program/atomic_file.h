// SPDX-License-Identifier: MIT
// Files that are written whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string_view>

namespace alpenglow::lut {

/// Writes a file whole or not at all: `write` gets the name of an empty temporary in the target's
/// folder (mode from the umask, a name that no other process uses), which is flushed to the disk
/// and renamed to `target` when `write` returns. Creates no folders; a symbolic link is followed; a
/// target that exists and is no regular file (a folder, a device) is refused.
///
/// On failure the temporary is removed. OutputError and filesystem_error from `write` become an
/// OutputError that names the target; other exceptions pass.
void WriteFileAtomically(const std::filesystem::path& target,
                         const std::function<void(const std::filesystem::path&)>& write);

/// As above, with the whole content given.
void WriteTextAtomically(const std::filesystem::path& target, std::string_view text);

/// Throws the OutputError that writing there would end with (no such folder, no right, a folder of
/// that name): before the work, so that it is not lost.
void RequireWritable(const std::filesystem::path& target);

/// The name that content for `target` goes to: the end of a symbolic link. Throws OutputError for
/// what exists and is no regular file.
[[nodiscard]] std::filesystem::path FinalName(const std::filesystem::path& target);

/// Removes the temporaries in a folder whose writers were killed, and no others: of this machine,
/// by their names (a farm shares folders), and locked by nobody, as their writers keep them until
/// they are done. File systems without locks keep theirs. Returns how many were removed.
std::size_t RemoveAbandonedTemporaries(const std::filesystem::path& folder);

}  // namespace alpenglow::lut
