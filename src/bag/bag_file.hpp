// SPDX-License-Identifier: BSD-3-Clause
// Reads the messages of a ROS 1 bag (format 2.0). Every offset in the file is checked before it is
// used; Debian's librosbag-storage does not check them and crashes on damaged bags.
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

/// The position of a message in a bag.
struct BagMessage {
    std::uint64_t chunk = 0;   ///< position of its chunk in the file [bytes]
    std::uint32_t offset = 0;  ///< position in the uncompressed chunk [bytes]
    std::uint32_t size = 0;
    double received = 0.;  ///< time at which it was recorded [s]
};

/// A bag that is read chunk by chunk. The chunk read last is kept in memory.
class BagFile {
  public:
    /// @throws InputError for a file that is missing, no bag, of an older format, or encrypted
    explicit BagFile(const std::string& file);

    const std::string& file() const { return file_; }

    /// Whether a file begins with the signature of a bag.
    static bool isBag(const std::string& file);

    using Visit =
        std::function<void(const BagTopic&, const BagMessage&, std::span<const std::uint8_t>)>;
    /// Calls `visit` with each message, in the order of the file.
    /// @throws InputError for a bag that is cut short or damaged, and what `visit` throws, with the
    ///         file's name
    void forEachMessage(const Visit& visit);

    /// The bytes of a message, valid until another message is read.
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
