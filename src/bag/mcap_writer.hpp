// SPDX-License-Identifier: BSD-3-Clause
// Writes MCAP files (mcap.dev) with time-stamped JSON messages, which Foxglove opens.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace photonav {

/// Collects messages and writes them in uncompressed chunks with checksums. An index lets a reader
/// jump to any time.
class McapWriter {
  public:
    using ChannelId = std::uint16_t;

    /// Whether a file begins as those of this writer do, which name it.
    static bool isOurs(const std::string& file);

    /// @param schema JSON Schema of the channel's messages. If several channels give the same
    ///         schemaName, the schema of the first one is used for all.
    ChannelId addChannel(const std::string& topic, const std::string& schemaName,
                         const std::string& schema);

    /// @param time [s], not negative; messages may come in any order
    /// @param json of the channel's schema
    void add(ChannelId channel, double time, std::string json);

    std::size_t messages() const { return messages_.size(); }

    /// The file, with the messages in order of time.
    std::string content() const;

  private:
    struct Schema {
        std::string name, text;
    };
    struct Channel {
        std::uint16_t schema = 0;  ///< number of its schema, from 1 on
        std::string topic;
    };
    struct Message {
        std::uint64_t time = 0;  ///< [ns]
        ChannelId channel = 0;
        std::string json;
    };
    /// The index entry of a chunk.
    struct Chunk {
        std::uint64_t first = 0, last = 0;  ///< times [ns]
        std::uint64_t start = 0, length = 0, indexLength = 0, size = 0;
        std::map<ChannelId, std::uint64_t>
            indices;  ///< by channel: position in the file of the index of its messages
    };

    std::string schemaRecords() const;
    std::string channelRecords() const;
    Chunk appendChunk(std::string& file, const std::vector<const Message*>& messages) const;
    std::string chunkIndices(const std::vector<Chunk>& chunks) const;
    std::string statistics(const std::vector<Chunk>& chunks) const;
    void appendSummary(std::string& file, const std::vector<Chunk>& chunks) const;

    std::vector<Schema> schemas_;
    std::vector<Channel> channels_;
    std::vector<Message> messages_;
};

}  // namespace photonav
