// SPDX-License-Identifier: BSD-3-Clause
#include "runs/journal_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "io/atomic_file.hpp"
#include "io/durable_file.hpp"
#include "io/error.hpp"
#include "io/json_nesting.hpp"
#include "io/reading.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

constexpr int kJournalSchema = 1;

std::string schemaKey(const RunWords& words) { return std::string("photonav_") + words.command; }

JournalHeader headerFrom(const json& line, const RunWords& words) {
    if (line.at(schemaKey(words)) != kJournalSchema) throw std::out_of_range("another version");
    return {line.at("name"),
            line.at("config"),
            line.at("identity"),
            {wholeNumber<unsigned>(line.at("shard").at(0)),
             wholeNumber<unsigned>(line.at("shard").at(1))}};
}

json lineOf(const JournalHeader& header, const RunWords& words) {
    return {{schemaKey(words), kJournalSchema},
            {"name", header.name},
            {"config", header.config},
            {"identity", header.identity},
            {"shard", {header.shard.index, header.shard.count}}};
}

}  // namespace

void JournalFile::create(const JournalHeader& header, const std::string& lines) {
    const std::string text = jsonLine(lineOf(header, words_)) + lines;
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
            const json line = json::parse(text);
            if (number == 1)
                header = headerFrom(line, words_);
            else
                onLine(line);
        } catch (const InputError&) {
            throw;
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const std::exception&) {
            throw InputError(
                path_.string(), fmt::format("line {}", number),
                fmt::format("not a {} of this version of photonav {}", words_.run, words_.command));
        }
        size_ += text.size() + 1;
    }
    if (number == 0) throw InputError(path_.string(), "", "empty");
    return header;
}

void JournalFile::append(const json& line) {
    if (!stream_.is_open()) {
        std::error_code ignored;  // a new file
        fs::resize_file(path_, size_, ignored);
        stream_.open(path_, std::ios::app);
    }
    const std::string text = jsonLine(line);
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
