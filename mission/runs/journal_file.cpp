// SPDX-License-Identifier: BSD-3-Clause
#include "runs/journal_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "io/atomic_file.hpp"
#include "io/checksum.hpp"
#include "io/durable_file.hpp"
#include "io/error.hpp"
#include "io/json_nesting.hpp"
#include "io/reading.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

constexpr int kJournalSchema = 2;
constexpr std::string_view kChecksum = R"({"crc32":")";
constexpr std::size_t kDigits = 8;

std::string schemaKey(const RunWords& words) { return std::string("photonav_") + words.command; }

JournalHeader headerFrom(const json& line, const RunWords& words) {
    const auto require = [](bool holds, const char* what) {
        if (!holds) throw std::out_of_range(what);
    };
    require(line.at(schemaKey(words)) == kJournalSchema, "another version");
    JournalHeader header{line.at("name"),
                         line.at("config"),
                         line.at("identity"),
                         {wholeNumber<unsigned>(line.at("shard").at(0)),
                          wholeNumber<unsigned>(line.at("shard").at(1))}};
    // A result folder may be named by it.
    require(header.name == fs::path(header.name).filename() && oneLine(header.name) == header.name,
            "name");
    require(header.shard.index >= 1 && header.shard.index <= header.shard.count, "shard");
    return header;
}

json lineOf(const JournalHeader& header, const RunWords& words) {
    return {{schemaKey(words), kJournalSchema},
            {"name", header.name},
            {"config", header.config},
            {"identity", header.identity},
            {"shard", {header.shard.index, header.shard.count}}};
}

struct DamagedLine : std::runtime_error {
    using std::runtime_error::runtime_error;
};

std::string textOf(const json& line) { return withChecksum(compactJson(line)) + "\n"; }

}  // namespace

std::string withChecksum(std::string_view object) {
    object.remove_prefix(1);
    return fmt::format("{}{:08x}\",{}", kChecksum, crc32(object), object);
}

std::string withoutChecksum(std::string_view line) {
    constexpr std::size_t kRest = kChecksum.size() + kDigits + 2;
    if (line.size() <= kRest || !line.starts_with(kChecksum)) {
        throw std::out_of_range("no checksum");
    }
    const std::string object = fmt::format("{{{}", line.substr(kRest));
    if (withChecksum(object) != line) {
        throw DamagedLine("its checksum does not fit: it was changed, or is damaged");
    }
    return object;
}

void JournalFile::create(const JournalHeader& header, const std::vector<json>& lines) {
    std::string text = textOf(lineOf(header, words_));
    for (const json& line : lines) text += textOf(line);
    writeFileAtomically(path_, text);
    size_ = text.size();
}

JournalHeader JournalFile::read(const std::function<void(const json&)>& onLine) {
    return reading(path_.string(), [&] { return readLines(onLine); });
}

JournalHeader JournalFile::readLines(const std::function<void(const json&)>& onLine) {
    std::ifstream stream = openIfThere(path_.string());
    if (!stream) {
        throw InputError(path_.string(), "",
                         fmt::format("no such file; is this {}?", words_.aWhole));
    }
    JournalHeader header;
    int number = 0;
    for (std::string text; std::getline(stream, text) && !stream.eof();) {
        ++number;
        try {
            if (nestingDepth(text) > kMostJsonDepth) throw std::out_of_range("nested too deep");
            const json line = json::parse(withoutChecksum(text));
            if (number == 1)
                header = headerFrom(line, words_);
            else
                onLine(line);
        } catch (const InputError&) {
            throw;
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const DamagedLine& damage) {
            throw InputError(path_.string(), fmt::format("line {}", number), damage.what());
        } catch (const std::exception&) {
            throw InputError(
                path_.string(), fmt::format("line {}", number),
                fmt::format("not a {} of this version of photonav {}", words_.run, words_.command));
        }
        size_ += text.size() + 1;
    }
    if (number == 0) {
        throw InputError(path_.string(), "",
                         fs::file_size(path_) == 0 ? "empty" : "its first line is cut short");
    }
    return header;
}

void JournalFile::append(const json& line) {
    if (!stream_.is_open()) {
        std::error_code ignored;  // a new file
        fs::resize_file(path_, size_, ignored);
        stream_.open(path_, std::ios::app);
    }
    const std::string text = textOf(line);
    const auto dropLine = [&] {
        stream_.close();          // tries once more
        std::error_code ignored;  // a line that was cut is dropped by readers, too
        fs::resize_file(path_, size_, ignored);
    };
    errno = 0;
    stream_ << text << std::flush;
    if (stream_) {
        try {
            synchronise(path_, path_);
        } catch (const InputError&) {
            dropLine();
            throw;
        }
        size_ += text.size();
        return;
    }
    const std::string reason = errno != 0 ? std::strerror(errno) : "input/output error";
    dropLine();
    throw InputError(path_.string(), "", "cannot be written: " + reason);
}

}  // namespace photonav
