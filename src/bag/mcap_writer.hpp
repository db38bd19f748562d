// SPDX-License-Identifier: BSD-3-Clause
// MCAP files (mcap.dev), the recordings that Foxglove opens: messages in time, of JSON.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace photonav {

/// Collects messages, and writes them as chunks that are not compressed, with checksums and an
/// index, so that a reader can jump to any time.
class McapWriter {
  public:
    using ChannelId = std::uint16_t;

    /// @param schema JSON Schema of its messages; channels with schemas of one name share the first
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
    /// What the index says of a chunk.
    struct Chunk {
        std::uint64_t first = 0, last = 0;  ///< times [ns]
        std::uint64_t start = 0, length = 0, indexLength = 0, size = 0;
        std::map<ChannelId, std::uint64_t> indices;  ///< where its messages of a channel are listed
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
