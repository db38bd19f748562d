// SPDX-License-Identifier: BSD-3-Clause
// The messages of a ROS 1 bag (format 2.0). Debian's librosbag-storage trusts the offsets that a
// bag gives and crashes on a damaged one; here each is checked before it is used.
#pragma once

#include <cstdint>
#include <fstream>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace photonav {

struct BagTopic {
    std::string name;
    std::string type;  ///< "sensor_msgs/Image"
};

/// Where a message lies.
struct BagMessage {
    std::uint64_t chunk = 0;   ///< position of its chunk in the file
    std::uint32_t offset = 0;  ///< in the chunk, uncompressed
    std::uint32_t size = 0;
    double received = 0.;  ///< when it was recorded [s]
};

/// Reads one chunk at a time, and keeps the last one.
class BagFile {
  public:
    /// @throws InputError for a file that is missing, no bag, of an older format, or encrypted
    explicit BagFile(const std::string& file);

    const std::string& file() const { return file_; }

    /// Whether a file begins as a bag does.
    static bool isBag(const std::string& file);

    using Visit =
        std::function<void(const BagTopic&, const BagMessage&, std::span<const std::uint8_t>)>;
    /// Calls `visit` with each message, in the order in which they were recorded.
    /// @throws InputError for a bag that is cut short or damaged, and what `visit` throws, with the
    ///         file's name
    void forEachMessage(const Visit& visit);

    /// The bytes of a message, until another one is read.
    /// @throws InputError if the file has changed
    std::span<const std::uint8_t> read(const BagMessage& message);

  private:
    struct Record {
        std::vector<std::uint8_t> header;
        std::uint32_t size = 0;  ///< of the data, which follow in the file
    };

    Record nextRecord();
    void loadChunk(std::uint64_t position, const Record& record);
    void visitChunk(const Visit& visit, std::map<std::uint32_t, BagTopic>& topics);

    std::string file_;
    std::ifstream stream_;
    std::uint64_t fileSize_ = 0;
    std::uint64_t chunkPosition_ = 0;  ///< of the chunk that is loaded; 0: none
    std::vector<std::uint8_t> chunk_;
};

}  // namespace photonav
