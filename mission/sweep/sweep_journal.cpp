// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/sweep_journal.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <stdexcept>

#include "geometry/constants.hpp"
#include "io/atomic_file.hpp"
#include "io/error.hpp"
#include "io/reading.hpp"
#include "result/json_values.hpp"

namespace photonav {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

constexpr int kJournalSchema = 1;

/// A whole number that the type can hold. @throws std::exception for others
template <typename Number>
Number whole(const json& value) {
    if (!value.is_number_unsigned()) throw std::invalid_argument("not a whole number");
    const auto number = value.get<std::uint64_t>();
    if (number > std::numeric_limits<Number>::max()) throw std::out_of_range("too large");
    return static_cast<Number>(number);
}

/// @throws std::exception for what no run gives
SweepRun runFrom(const json& line) {
    const auto number = [&](const char* key) {
        if (line.at(key).is_null()) return kNone;
        const auto value = line.at(key).get<double>();
        if (!(value >= 0.)) throw std::out_of_range(key);  // costs, lengths and traces
        return value;
    };
    SweepRun run{{line.at("planner"), line.at("alpha"), whole<std::uint32_t>(line.at("seed"))},
                 number("cost"),
                 number("length"),
                 number("mean_trace"),
                 number("goal_trace"),
                 whole<std::size_t>(line.at("vertices")),
                 whole<std::size_t>(line.at("views")),
                 number("seconds"),
                 line.at("status"),
                 {}};
    if (run.isSolved() != std::isfinite(run.cost)) throw std::out_of_range("cost");
    for (const json& p : line.at("path")) run.path.emplace_back(p.at(0), p.at(1), p.at(2));
    return run;
}

SweepHeader headerFrom(const json& line) {
    if (line.at("photonav_sweep") != kJournalSchema) throw InputError("", "", "of another version");
    return {line.at("name"),
            line.at("config"),
            line.at("identity"),
            {whole<unsigned>(line.at("shard").at(0)), whole<unsigned>(line.at("shard").at(1))}};
}

json lineOf(const SweepHeader& header) {
    return {{"photonav_sweep", kJournalSchema},
            {"name", header.name},
            {"config", header.config},
            {"identity", header.identity},
            {"shard", {header.shard.index, header.shard.count}}};
}

json lineOf(const SweepRun& run) {
    json line = toJson(run);
    line["path"] = json::array();
    for (const Eigen::Vector3d& p : run.path) line["path"].push_back({p.x(), p.y(), p.z()});
    return line;
}

}  // namespace

json toJson(const SweepRun& run) {
    return {{"planner", run.item.planner},
            {"alpha", run.item.alpha},
            {"seed", run.item.seed},
            {"cost", finiteOrNull(run.cost)},
            {"length", finiteOrNull(run.length)},
            {"mean_trace", finiteOrNull(run.meanTrace)},
            {"goal_trace", finiteOrNull(run.goalTrace)},
            {"vertices", run.vertices},
            {"views", run.views},
            {"seconds", run.seconds},
            {"status", run.status}};
}

SweepJournal SweepJournal::create(const fs::path& folder, const SweepHeader& header,
                                  std::vector<SweepRun> runs) {
    SweepJournal journal(folder / kFileName);
    std::string text = jsonLine(lineOf(header));
    for (const SweepRun& run : runs) text += jsonLine(lineOf(run));
    writeFileAtomically(journal.file_, text);
    journal.header_ = header;
    journal.runs_ = std::move(runs);
    journal.size_ = text.size();
    return journal;
}

SweepJournal SweepJournal::read(const fs::path& folder) {
    return reading((folder / kFileName).string(), [&] { return readLines(folder); });
}

SweepJournal SweepJournal::readLines(const fs::path& folder) {
    SweepJournal journal(folder / kFileName);
    std::ifstream stream = openToRead(journal.file_.string());
    if (!stream) throw InputError(journal.file_.string(), "", "no such file; is this a sweep?");
    int number = 0;
    std::set<SweepItem> known;
    for (std::string text; std::getline(stream, text) && !stream.eof();) {
        ++number;
        try {
            const json line = json::parse(text);
            if (number == 1) {
                journal.header_ = headerFrom(line);
            } else if (SweepRun run = runFrom(line); known.insert(run.item).second) {
                journal.runs_.push_back(std::move(run));
            }
        } catch (const std::bad_alloc&) {
            throw;
        } catch (const std::exception&) {
            throw InputError(journal.file_.string(), fmt::format("line {}", number),
                             "not a run of this version of photonav sweep");
        }
        journal.size_ += text.size() + 1;
    }
    if (number == 0) throw InputError(journal.file_.string(), "", "empty");
    return journal;
}

void SweepJournal::write(const json& line) {
    if (!stream_.is_open()) {
        std::error_code ignored;  // a new file
        fs::resize_file(file_, size_, ignored);
        stream_.open(file_, std::ios::app);
    }
    const std::string text = jsonLine(line);
    errno = 0;
    stream_ << text << std::flush;
    if (stream_) {
        size_ += text.size();
        return;
    }
    const std::string reason = errno != 0 ? std::strerror(errno) : "input/output error";
    stream_.close();          // tries once more
    std::error_code ignored;  // a line that was cut is dropped by readers, too
    fs::resize_file(file_, size_, ignored);
    throw InputError(file_.string(), "", "cannot be written: " + reason);
}

void SweepJournal::append(const SweepRun& run) {
    write(lineOf(run));
    runs_.push_back(run);
}

std::vector<SweepRun> SweepJournal::runsOf(const std::vector<SweepItem>& items) const {
    const std::set<SweepItem> wanted(items.begin(), items.end());
    std::vector<SweepRun> runs = runs_;
    std::erase_if(runs, [&](const SweepRun& run) { return !wanted.contains(run.item); });
    return runs;
}

std::vector<SweepItem> SweepJournal::missing(const std::vector<SweepItem>& items) const {
    std::set<SweepItem> done;
    for (const SweepRun& run : runs_) done.insert(run.item);
    std::vector<SweepItem> open = items;
    std::erase_if(open, [&](const SweepItem& item) { return done.contains(item); });
    return open;
}

}  // namespace photonav
