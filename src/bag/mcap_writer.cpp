// SPDX-License-Identifier: BSD-3-Clause
#include "bag/mcap_writer.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <stdexcept>

#include "bag/file_magic.hpp"

namespace photonav {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are stored as in memory");

constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
constexpr std::size_t kChunkSize = 1U << 20U;  // [bytes], about

/// Opcodes of the specification.
enum class Op : std::uint8_t {
    header = 1,
    footer = 2,
    schema = 3,
    channel = 4,
    message = 5,
    chunk = 6,
    messageIndex = 7,
    chunkIndex = 8,
    statistics = 11,
    summaryOffset = 14,
    dataEnd = 15,
};

std::uint32_t checksum(std::string_view bytes) {
    return static_cast<std::uint32_t>(
        crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

/// Fields one after the other, texts and tables after their length.
class McapFields {
  public:
    template <std::unsigned_integral Number>
    McapFields& number(Number value) {
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
        return *this;
    }
    McapFields& text(std::string_view text) {
        number(static_cast<std::uint32_t>(text.size()));
        return raw(text);
    }
    McapFields& raw(std::string_view bytes) {
        bytes_.append(bytes);
        return *this;
    }
    /// The record, with opcode and length.
    std::string as(Op op) const {
        McapFields record;
        record.number(static_cast<std::uint8_t>(op)).number(std::uint64_t(bytes_.size()));
        return record.raw(bytes_).bytes_;
    }
    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

/// Of a file by this writer: it says by whom it was written.
std::string beginning() {
    return std::string(kMcapMagic) + McapFields().text("").text("photonav").as(Op::header);
}

template <typename Key>
std::string tableOf(const std::map<Key, std::uint64_t>& table) {
    McapFields fields;
    for (const auto& [key, value] : table) fields.number(key).number(value);
    return fields.bytes();
}

}  // namespace

bool McapWriter::isOurs(const std::string& file) { return beginsWith(file, beginning()); }

McapWriter::ChannelId McapWriter::addChannel(const std::string& topic,
                                             const std::string& schemaName,
                                             const std::string& schema) {
    auto found = std::ranges::find(schemas_, schemaName, &Schema::name);
    if (found == schemas_.end()) {
        schemas_.push_back({schemaName, schema});
        found = schemas_.end() - 1;
    }
    channels_.push_back({static_cast<std::uint16_t>(found - schemas_.begin() + 1), topic});
    return static_cast<ChannelId>(channels_.size() - 1);
}

void McapWriter::add(ChannelId channel, double time, std::string json) {
    constexpr double kNanoseconds = 1e9, kLast = 1e10;  // [s], of the year 2286
    if (!(time >= 0. && time <= kLast)) {
        throw std::invalid_argument(fmt::format("{}: time {:g} s is not within 0 and {:g} s",
                                                channels_.at(channel).topic, time, kLast));
    }
    messages_.push_back(
        {static_cast<std::uint64_t>(std::llround(kNanoseconds * time)), channel, std::move(json)});
}

std::string McapWriter::schemaRecords() const {
    std::string records;
    for (std::size_t i = 0; i < schemas_.size(); ++i) {
        records += McapFields()
                       .number(static_cast<std::uint16_t>(i + 1))
                       .text(schemas_[i].name)
                       .text("jsonschema")
                       .text(schemas_[i].text)
                       .as(Op::schema);
    }
    return records;
}

std::string McapWriter::channelRecords() const {
    std::string records;
    for (std::size_t i = 0; i < channels_.size(); ++i) {
        records += McapFields()
                       .number(static_cast<std::uint16_t>(i))
                       .number(channels_[i].schema)
                       .text(channels_[i].topic)
                       .text("json")
                       .text("")  // no metadata
                       .as(Op::channel);
    }
    return records;
}

McapWriter::Chunk McapWriter::appendChunk(std::string& file,
                                          const std::vector<const Message*>& messages) const {
    std::string records;
    std::map<ChannelId, std::string> lists;
    Chunk chunk{messages.front()->time, messages.back()->time, file.size(), 0, 0, 0, {}};
    for (const Message* message : messages) {
        lists[message->channel] +=
            McapFields().number(message->time).number(std::uint64_t(records.size())).bytes();
        records += McapFields()
                       .number(message->channel)
                       .number(std::uint32_t{0})
                       .number(message->time)
                       .number(message->time)
                       .raw(message->json)
                       .as(Op::message);
    }
    chunk.size = records.size();
    file += McapFields()
                .number(chunk.first)
                .number(chunk.last)
                .number(chunk.size)
                .number(checksum(records))
                .text("")  // no compression
                .number(chunk.size)
                .raw(records)
                .as(Op::chunk);
    chunk.length = file.size() - chunk.start;
    for (const auto& [channel, list] : lists) {
        chunk.indices[channel] = file.size();
        file += McapFields().number(channel).text(list).as(Op::messageIndex);
    }
    chunk.indexLength = file.size() - chunk.start - chunk.length;
    return chunk;
}

std::string McapWriter::chunkIndices(const std::vector<Chunk>& chunks) const {
    std::string records;
    for (const Chunk& chunk : chunks) {
        records += McapFields()
                       .number(chunk.first)
                       .number(chunk.last)
                       .number(chunk.start)
                       .number(chunk.length)
                       .text(tableOf(chunk.indices))
                       .number(chunk.indexLength)
                       .text("")  // no compression
                       .number(chunk.size)
                       .number(chunk.size)
                       .as(Op::chunkIndex);
    }
    return records;
}

std::string McapWriter::statistics(const std::vector<Chunk>& chunks) const {
    std::map<ChannelId, std::uint64_t> counts;
    for (const Message& message : messages_) ++counts[message.channel];
    return McapFields()
        .number(std::uint64_t(messages_.size()))
        .number(static_cast<std::uint16_t>(schemas_.size()))
        .number(static_cast<std::uint32_t>(channels_.size()))
        .number(std::uint32_t{0})  // attachments
        .number(std::uint32_t{0})  // metadata
        .number(static_cast<std::uint32_t>(chunks.size()))
        .number(chunks.empty() ? std::uint64_t{0} : chunks.front().first)
        .number(chunks.empty() ? std::uint64_t{0} : chunks.back().last)
        .text(tableOf(counts))
        .as(Op::statistics);
}

void McapWriter::appendSummary(std::string& file, const std::vector<Chunk>& chunks) const {
    const std::uint64_t start = file.size();
    std::string offsets;
    const auto append = [&](Op op, const std::string& records) {
        if (records.empty()) return;
        offsets += McapFields()
                       .number(static_cast<std::uint8_t>(op))
                       .number(std::uint64_t(file.size()))
                       .number(std::uint64_t(records.size()))
                       .as(Op::summaryOffset);
        file += records;
    };
    append(Op::schema, schemaRecords());
    append(Op::channel, channelRecords());
    append(Op::chunkIndex, chunkIndices(chunks));
    append(Op::statistics, statistics(chunks));
    const std::uint64_t offsetsStart = file.size();
    file += offsets;
    // The checksum covers the summary and the footer but for itself.
    const std::string footer =
        McapFields().number(start).number(offsetsStart).number(std::uint32_t{0}).as(Op::footer);
    file += footer.substr(0, footer.size() - sizeof(std::uint32_t));
    file += McapFields().number(checksum(std::string_view(file).substr(start))).bytes();
}

std::string McapWriter::content() const {
    std::vector<const Message*> ordered;
    ordered.reserve(messages_.size());
    for (const Message& message : messages_) ordered.push_back(&message);
    std::ranges::stable_sort(ordered, {}, &Message::time);
    std::string file = beginning();
    file += schemaRecords() + channelRecords();
    std::vector<Chunk> chunks;
    std::vector<const Message*> inChunk;
    std::size_t size = 0;
    for (const Message* message : ordered) {
        inChunk.push_back(message);
        size += message->json.size();
        if (size < kChunkSize && message != ordered.back()) continue;
        chunks.push_back(appendChunk(file, inChunk));
        inChunk.clear();
        size = 0;
    }
    file += McapFields().number(checksum(file)).as(Op::dataEnd);
    appendSummary(file, chunks);
    return file.append(kMcapMagic);
}

}  // namespace photonav
