// SPDX-License-Identifier: BSD-3-Clause
#include "io/manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

#include "io/atomic_file.hpp"
#include "io/checksum.hpp"
#include "io/durable_file.hpp"
#include "io/error.hpp"
#include "io/reading.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

constexpr const char* kFirstLine = "photonav files 1";
constexpr std::string_view kReplaces = "replaces ";

std::uint32_t checksumOf(const fs::path& file) {
    std::ifstream stream = openIfThere(file.string());
    std::vector<char> block(1U << 20U);
    std::uint32_t sum = 0;
    while (stream) {
        stream.read(block.data(), static_cast<std::streamsize>(block.size()));
        sum = crc32({block.data(), static_cast<std::size_t>(stream.gcount())}, sum);
    }
    return sum;
}

/// Files, links and empty folders of a folder and its subfolders, relative, sorted, the manifest
/// left out.
std::vector<fs::path> namesIn(const fs::path& folder) {
    std::vector<fs::path> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (fs::is_directory(entry.symlink_status()) && !fs::is_empty(entry)) continue;
        const fs::path name = entry.path().lexically_relative(folder);
        if (name != Manifest::kFileName) names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace

Manifest::File Manifest::describe(const fs::path& folder, const fs::path& name) {
    const fs::path file = folder / name;
    if (!fs::is_regular_file(fs::symlink_status(file))) return {name, 0, 0};
    return {name, fs::file_size(file), checksumOf(file)};
}

Manifest Manifest::of(const fs::path& folder) {
    Manifest manifest;
    for (const fs::path& name : namesIn(folder)) manifest.files_.push_back(describe(folder, name));
    return manifest;
}

Manifest Manifest::read(const fs::path& folder) {
    Manifest manifest;
    const fs::path file = folder / kFileName;
    std::ifstream stream = openIfThere(file.string());
    std::string line;
    if (!stream || !std::getline(stream, line)) return manifest;
    const auto fail = [&] { throw InputError(file.string(), "", "is damaged"); };
    if (line != kFirstLine) {
        throw InputError(file.string(), "", "is damaged, or of another version of photonav");
    }
    while (std::getline(stream, line)) {
        const bool isReplaces = line.starts_with(kReplaces);
        std::istringstream fields = wordsOf(isReplaces ? line.substr(kReplaces.size()) : line);
        if (isReplaces) {
            std::uint32_t replaced = 0;
            if (!(fields >> std::hex >> replaced)) fail();
            manifest.replaces_ = replaced;
            continue;
        }
        File entry{};
        std::string name;
        fields >> entry.size >> std::hex >> entry.checksum;
        if (!fields || fields.get() != ' ' || !std::getline(fields, name)) fail();
        entry.name = name;
        manifest.files_.push_back(std::move(entry));
    }
    return manifest;
}

void Manifest::setReplaced(const fs::path& folder) { replaces_ = checksumOf(folder / kFileName); }

bool Manifest::hasReplaced(const fs::path& folder) const {
    return replaces_ == checksumOf(folder / kFileName);
}

std::string Manifest::text() const {
    std::string text = std::string(kFirstLine) + "\n";
    if (replaces_) text += fmt::format("{}{:08x}\n", kReplaces, *replaces_);
    for (const File& file : files_) {
        text += fmt::format("{} {:08x} {}\n", file.size, file.checksum, file.name.string());
    }
    return text;
}

std::vector<Manifest::File>::const_iterator Manifest::placeOf(const fs::path& name) const {
    return std::lower_bound(files_.begin(), files_.end(), name,
                            [](const File& file, const fs::path& n) { return file.name < n; });
}

std::optional<fs::path> Manifest::foreignFile(const fs::path& folder) const {
    for (const fs::path& name : namesIn(folder)) {
        if (!lists(folder, name) && !isUnfinished(folder, name)) return name;
    }
    return {};
}

bool Manifest::isListed(const fs::path& name) const {
    const auto listed = placeOf(name);
    return listed != files_.end() && listed->name == name;
}

/// Whether it is a temporary file of a listed file, or of the manifest.
bool Manifest::isUnfinished(const fs::path& folder, const fs::path& name) const {
    if (!isTemporaryFile(name) || !fs::is_regular_file(fs::symlink_status(folder / name))) {
        return false;
    }
    const fs::path whole = name.parent_path() / name.stem();
    return isListed(whole) || (!empty() && whole == kFileName);
}

/// A folder in which listed files were is listed, too.
bool Manifest::lists(const fs::path& folder, const fs::path& name) const {
    const auto listed = placeOf(name);
    if (listed == files_.end()) return false;
    if (*listed == describe(folder, name)) return true;
    const auto [end, rest] =
        std::mismatch(name.begin(), name.end(), listed->name.begin(), listed->name.end());
    return end == name.end() && rest != listed->name.end() &&
           fs::is_directory(fs::symlink_status(folder / name));
}

void Manifest::renew(const fs::path& folder, const fs::path& name) {
    Manifest manifest = read(folder);
    if (manifest.empty()) return;
    const auto place =
        manifest.files_.begin() + (manifest.placeOf(name) - manifest.files_.cbegin());
    if (place != manifest.files_.end() && place->name == name) {
        *place = describe(folder, name);
    } else {
        manifest.files_.insert(place, describe(folder, name));
    }
    replaceFile(folder / kFileName, manifest.text());
}

void Manifest::removeFiles(const fs::path& folder) const {
    std::error_code ignored;
    for (const fs::path& name : namesIn(folder)) {
        if (isListed(name) || isUnfinished(folder, name)) fs::remove(folder / name, ignored);
    }
}

}  // namespace photonav
