// SPDX-License-Identifier: BSD-3-Clause
#include "bag/bag_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "bag/byte_reader.hpp"
#include "bag/chunk_compression.hpp"
#include "bag/file_magic.hpp"
#include "io/reading.hpp"

namespace photonav {
namespace {

using Fields = std::map<std::string, ByteSpan>;

constexpr std::string_view kMagic = "#ROSBAG V";
constexpr std::string_view kBagVersion = "2.0\n";
constexpr std::uint32_t kLongestHeader = 1U << 16U;  // [bytes]; with a topic's name
constexpr std::uint8_t kMessage = 2, kBagHeader = 3, kChunk = 5, kConnection = 7;
/// The most that chunks may unpack to, in sizes of the file. Images of nothing but black unpack to
/// more, but are of no use.
constexpr std::uint64_t kMostCompression = 1000;

/// Fields "name=value", each after its length.
Fields fieldsOf(ByteSpan header) {
    Fields fields;
    for (ByteReader reader(header); !reader.isAtEnd();) {
        const ByteSpan field = reader.block();
        std::size_t nameLength = 0;
        while (nameLength < field.size() && field[nameLength] != '=') ++nameLength;
        if (nameLength == field.size()) throw std::runtime_error("damaged: a field has no value");
        fields[std::string(field.begin(), field.begin() + std::ptrdiff_t(nameLength))] =
            field.subspan(nameLength + 1);
    }
    return fields;
}

ByteSpan valueOf(const Fields& fields, const char* name) {
    const auto field = fields.find(name);
    if (field == fields.end()) {
        throw std::runtime_error(fmt::format("damaged: a record has no field '{}'", name));
    }
    return field->second;
}

template <typename Number>
Number numberOf(const Fields& fields, const char* name) {
    return ByteReader(valueOf(fields, name)).number<Number>();
}

std::string textOf(const Fields& fields, const char* name) {
    const ByteSpan value = valueOf(fields, name);
    return {value.begin(), value.end()};
}

double timeOf(const Fields& fields) {
    ByteReader reader(valueOf(fields, "time"));
    const auto seconds = reader.number<std::uint32_t>();
    return seconds + 1e-9 * reader.number<std::uint32_t>();
}

}  // namespace

bool BagFile::isBag(const std::string& file) { return beginsWith(file, kMagic); }

BagFile::BagFile(const std::string& file) : file_(file), stream_(openToRead(file)) {
    reading(file, [&] {
        fileSize_ = std::filesystem::file_size(file);
        std::string version(kBagVersion.size(), ' ');
        if (!isBag(file)) throw std::runtime_error("not a ROS bag");
        stream_.seekg(std::ptrdiff_t(kMagic.size()));
        stream_.read(version.data(), std::ptrdiff_t(version.size()));
        if (version != kBagVersion) {
            throw std::runtime_error("not a bag of format 2.0; `rosbag fix` of ROS converts it");
        }
        const Record record = nextRecord();
        const Fields fields = fieldsOf(record.header);
        if (numberOf<std::uint8_t>(fields, "op") != kBagHeader) {
            throw std::runtime_error("damaged: it does not begin with its header");
        }
        const auto encryptor = fields.find("encryptor");
        if (encryptor != fields.end() && !encryptor->second.empty()) {
            throw std::runtime_error("is encrypted");
        }
    });
}

BagFile::Record BagFile::nextRecord() {
    const auto left = [&] { return fileSize_ - static_cast<std::uint64_t>(stream_.tellg()); };
    const auto length = [&] {
        std::uint32_t value = 0;
        if (left() < sizeof(value)) throw std::runtime_error("is cut short");
        stream_.read(reinterpret_cast<char*>(&value), sizeof(value));
        if (value > left()) throw std::runtime_error("is cut short, or damaged");
        return value;
    };
    Record record;
    const std::uint32_t size = length();
    if (size > kLongestHeader) throw std::runtime_error("damaged: the header of a record");
    record.header.resize(size);
    stream_.read(reinterpret_cast<char*>(record.header.data()), size);
    record.size = length();
    return record;
}

void BagFile::loadChunk(std::uint64_t position, const Record& record) {
    chunkPosition_ = 0;
    const Fields fields = fieldsOf(record.header);
    std::vector<std::uint8_t> compressed(record.size);
    stream_.read(reinterpret_cast<char*>(compressed.data()), record.size);
    chunk_ = uncompressed(textOf(fields, "compression"), compressed,
                          numberOf<std::uint32_t>(fields, "size"));
    chunkPosition_ = position;
}

void BagFile::visitChunk(const Visit& visit, std::map<std::uint32_t, BagTopic>& topics) {
    for (ByteReader reader(chunk_); !reader.isAtEnd();) {
        const Fields fields = fieldsOf(reader.block());
        const ByteSpan data = reader.block();
        const auto op = numberOf<std::uint8_t>(fields, "op");
        if (op == kConnection) {
            topics[numberOf<std::uint32_t>(fields, "conn")] = {textOf(fields, "topic"),
                                                               textOf(fieldsOf(data), "type")};
        } else if (op == kMessage) {
            const auto topic = topics.find(numberOf<std::uint32_t>(fields, "conn"));
            if (topic == topics.end()) {
                throw std::runtime_error("damaged: a message without connection");
            }
            visit(topic->second,
                  {chunkPosition_, static_cast<std::uint32_t>(reader.position() - data.size()),
                   static_cast<std::uint32_t>(data.size()), timeOf(fields)},
                  data);
        }
    }
}

void BagFile::forEachMessage(const Visit& visit) {
    reading(file_, [&] {
        std::map<std::uint32_t, BagTopic> topics;
        std::uint64_t unpacked = 0;
        stream_.seekg(std::ptrdiff_t(kMagic.size() + kBagVersion.size()));
        while (static_cast<std::uint64_t>(stream_.tellg()) < fileSize_) {
            const auto position = static_cast<std::uint64_t>(stream_.tellg());
            const Record record = nextRecord();
            if (numberOf<std::uint8_t>(fieldsOf(record.header), "op") == kChunk) {
                loadChunk(position, record);
                unpacked += chunk_.size();
                if (unpacked > kLargestChunk + kMostCompression * fileSize_) {
                    throw std::runtime_error(fmt::format(
                        "its chunks unpack to more than {} times the file", kMostCompression));
                }
                visitChunk(visit, topics);
            } else {
                stream_.seekg(record.size, std::ios::cur);
            }
        }
    });
}

ByteSpan BagFile::read(const BagMessage& message) {
    return reading(file_, [&] {
        if (chunkPosition_ != message.chunk) {
            stream_.seekg(std::ptrdiff_t(message.chunk));
            loadChunk(message.chunk, nextRecord());
        }
        ByteReader reader(chunk_);
        reader.bytes(message.offset);
        return reader.bytes(message.size);
    });
}

}  // namespace photonav
