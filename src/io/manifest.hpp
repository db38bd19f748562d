// SPDX-License-Identifier: BSD-3-Clause
// What a result folder holds that this program wrote.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace photonav {

/// The list of files and empty folders that this program wrote into a folder. It is stored there as
/// `.photonav`, one line per file with size, checksum and name. What is not listed, or was changed
/// since, belongs to the user.
class Manifest {
  public:
    static constexpr const char* kFileName = ".photonav";

    /// The files of a folder and its subfolders, as they are now.
    static Manifest of(const std::filesystem::path& folder);

    /// The manifest of an earlier run; empty if the folder has none.
    /// @throws InputError when it is damaged
    static Manifest read(const std::filesystem::path& folder);

    /// States which result this one is to replace: the one whose manifest a folder has now.
    void setReplaced(const std::filesystem::path& folder);
    /// Whether the folder has the result of setReplaced(): this one has taken its place.
    bool hasReplaced(const std::filesystem::path& folder) const;

    std::string text() const;
    bool empty() const { return files_.empty(); }

    /// A file or an empty folder that is not listed or was changed since; nothing when all are
    /// listed. Unfinished new versions of listed files, which a killed process left, do not count.
    std::optional<std::filesystem::path> foreignFile(const std::filesystem::path& folder) const;

    /// Removes the listed files of the folder, and unfinished new versions of them. Links are not
    /// followed, and files outside of the folder are not removed even if a line names them.
    void removeFiles(const std::filesystem::path& folder) const;

    /// Updates the entry of a file that the program has written again. Does nothing if the folder
    /// has no manifest.
    static void renew(const std::filesystem::path& folder, const std::filesystem::path& name);

  private:
    struct File {
        std::filesystem::path name;  // relative to the folder
        std::uintmax_t size;         // [bytes]
        std::uint32_t checksum;      // CRC-32
        bool operator==(const File&) const = default;
    };
    bool isListed(const std::filesystem::path& name) const;
    bool isUnfinished(const std::filesystem::path& folder, const std::filesystem::path& name) const;
    bool lists(const std::filesystem::path& folder, const std::filesystem::path& name) const;
    /// Position of the first file whose name is not before this one in the sorted list.
    std::vector<File>::const_iterator placeOf(const std::filesystem::path& name) const;
    static File describe(const std::filesystem::path& folder, const std::filesystem::path& name);

    std::vector<File> files_;                // sorted by name
    std::optional<std::uint32_t> replaces_;  // CRC-32 of the manifest that was in place, 0: none
};

}  // namespace photonav
