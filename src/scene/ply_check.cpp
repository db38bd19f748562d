// SPDX-License-Identifier: BSD-3-Clause
#include "scene/ply_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>
#include <vector>

#include "io/error.hpp"
#include "io/image_bytes.hpp"
#include "io/number.hpp"
#include "io/reading.hpp"

namespace photonav {
namespace fs = std::filesystem;
namespace {

std::size_t binarySize(const std::string& type) {
    if (type == "char" || type == "uchar" || type == "int8" || type == "uint8") return 1;
    if (type == "short" || type == "ushort" || type == "int16" || type == "uint16") return 2;
    if (type == "double" || type == "float64") return 8;
    const bool isKnown = type == "int" || type == "uint" || type == "float" || type == "int32" ||
                         type == "uint32" || type == "float32";
    return isKnown ? 4 : 0;
}

bool isInteger(const std::string& type) {
    return !type.starts_with("float") && !type.starts_with("double");
}

std::size_t lengthSize(const std::string& type) { return isInteger(type) ? binarySize(type) : 0; }

struct PlyProperty {
    std::size_t size = 0;        // [bytes]
    std::size_t lengthSize = 0;  // of a list's length [bytes]; 0: no list
    bool isInteger = false;
};

struct PlyElement {
    std::string name;
    double count = 0.;
    std::vector<PlyProperty> properties = {};
};

/// Walks through the elements of a PLY file. Assimp makes room for whatever length a list claims,
/// and goes on where the file ends.
class PlyBody {
  public:
    /// @param bytes those after the header
    PlyBody(const std::string& file, const std::string& format, std::string_view bytes)
        : file_(file),
          isAscii_(format == "ascii"),
          isBigEndian_(format == "binary_big_endian"),
          rest_(bytes) {}

    void check(const PlyElement& element) {
        element_ = &element;
        for (row_ = 0; row_ < element.count; ++row_) {
            for (const PlyProperty& property : element.properties) {
                skip(property.lengthSize > 0 ? length(property.lengthSize) : 1., property.size,
                     property.isInteger);
            }
        }
    }

  private:
    double length(std::size_t size) {
        const double length = isAscii_ ? numberIn(word()).value_or(-1.) : integer(size);
        if (!(length >= 0. && length == std::floor(length))) fail("a list has no length");
        return length;
    }

    /// In text, a value takes a digit at least, and a blank before the next one.
    void skip(double values, std::size_t size, bool isInteger) {
        const double left = static_cast<double>(rest_.size());
        if (isAscii_ ? 2. * values - 1. > left : values * static_cast<double>(size) > left) {
            fail(fmt::format("{:.0f} values do not fit into the rest of the file", values));
        }
        const auto count = static_cast<std::size_t>(values);
        if (!isAscii_) {
            take(count * size);
        } else {
            for (std::size_t i = 0; i < count; ++i) number(isInteger);
        }
    }

    void number(bool isInteger) {
        const std::string_view text = word();
        const auto number = numberIn(text);
        if (!number) fail(fmt::format("'{}' is not a number", text));
        if (isInteger && *number != std::floor(*number)) {
            fail(fmt::format("'{}' is not an integer", text));
        }
    }

    std::string_view take(std::size_t bytes) {
        if (bytes > rest_.size()) fail("the file ends here");
        const std::string_view taken = rest_.substr(0, bytes);
        rest_.remove_prefix(bytes);
        return taken;
    }

    std::string_view word() {
        constexpr std::string_view kBlanks = " \t\r\n";
        rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
        return take(std::max<std::size_t>(1, std::min(rest_.find_first_of(kBlanks), rest_.size())));
    }

    double integer(std::size_t size) {
        const std::string_view bytes = take(size);
        std::uint64_t value = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t place = isBigEndian_ ? i : size - 1 - i;
            value = value << 8U | static_cast<unsigned char>(bytes[place]);
        }
        return static_cast<double>(value);
    }

    [[noreturn]] void fail(const std::string& reason) const {
        throw InputError(file_, "element " + element_->name,
                         fmt::format("number {}: {}", row_, reason));
    }

    const std::string& file_;
    bool isAscii_, isBigEndian_;
    std::string_view rest_;
    const PlyElement* element_ = nullptr;
    std::size_t row_ = 0;
};

/// The header of a PLY file, read line by line.
class PlyHeader {
  public:
    explicit PlyHeader(const std::string& file)
        : file_(file), size_(static_cast<double>(fs::file_size(file))) {}

    void check() {
        std::ifstream in = openToRead(file_);
        std::string line;
        std::getline(in, line);
        if (line.substr(0, 3) != "ply") throw InputError(file_, "", "does not begin with 'ply'");
        while (std::getline(in, line)) {
            std::istringstream words = wordsOf(line);
            std::string word;
            words >> word;
            if (word == "format") {
                readFormat(words);
            } else if (word == "element") {
                readElement(words);
            } else if (word == "property") {
                readProperty(words);
            } else if (word == "end_header") {
                checkProperties();
                if (format_.empty()) throw InputError(file_, "format", "missing");
                return checkBody(static_cast<std::size_t>(in.tellg()));
            } else if (!word.empty() && word != "comment" && word != "obj_info") {
                throw InputError(file_, "", fmt::format("'{}' in the header is not known", word));
            }
        }
        throw InputError(file_, "end_header", "missing");
    }

  private:
    void readFormat(std::istream& words) {
        words >> format_;
        if (format_ == "ascii" || format_ == "binary_little_endian" ||
            format_ == "binary_big_endian") {
            return;
        }
        throw InputError(file_, "format", fmt::format("'{}' is not known", format_));
    }

    void readElement(std::istream& words) {
        checkProperties();
        PlyElement element;
        words >> element.name >> element.count;
        const bool isCount = words && element.count >= 0.;
        elements_.push_back(element);
        if (!isCount || element.count != std::floor(element.count)) {
            fail("not a number of elements");
        }
    }

    /// The least that elements take: in text a digit and a blank each, of lists their length only.
    void readProperty(std::istream& words) {
        if (elements_.empty()) throw InputError(file_, "property", "is of no element");
        std::string type, lengthType;
        words >> type;
        if (type == "list") words >> lengthType >> type;
        const PlyProperty property{binarySize(type), lengthSize(lengthType), isInteger(type)};
        if (property.size == 0) fail(fmt::format("property of unknown type '{}'", type));
        if (!lengthType.empty() && property.lengthSize == 0) {
            fail(fmt::format("a list cannot have a length of type '{}'", lengthType));
        }
        PlyElement& element = elements_.back();
        element.properties.push_back(property);
        const std::size_t size = lengthType.empty() ? property.size : property.lengthSize;
        least_ += element.count * (format_ == "ascii" ? 2. : static_cast<double>(size));
        if (least_ <= size_ + 2.) return;
        fail(fmt::format("{:.0f} of them do not fit into {:.0f} bytes", element.count, size_));
    }

    /// Elements without properties take no bytes, so that any number of them would fit.
    void checkProperties() const {
        if (elements_.empty()) return;
        if (elements_.back().count > 0. && elements_.back().properties.empty()) {
            fail("has no properties");
        }
    }

    [[noreturn]] void fail(const std::string& reason) const {
        throw InputError(file_, "element " + elements_.back().name, reason);
    }

    void checkBody(std::size_t begin) const {
        const std::vector<std::uint8_t> bytes = readBytes(file_);
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        PlyBody body(file_, format_, text.substr(std::min(begin, text.size())));
        for (const PlyElement& element : elements_) body.check(element);
    }

    std::string file_;
    double size_;  // [bytes]
    double least_ = 0.;
    std::string format_;
    std::vector<PlyElement> elements_;
};

}  // namespace

void checkPly(const std::string& file) { PlyHeader(file).check(); }

}  // namespace photonav
