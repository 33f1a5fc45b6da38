// SPDX-License-Identifier: MIT
// Files that are written whole or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace alpenglow {

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

}  // namespace alpenglow
